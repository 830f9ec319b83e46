#include <stdexcept>
#include <string_view>

#include "core/base/error.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/message/figures.hpp"
#include "tests/fuzz/targets.hpp"

namespace lightnet::fuzz {
namespace {

template <class FromJson>
void read_with(FromJson from_json, std::string_view text) {
    std::string canonical;
    try {
        canonical = to_json(from_json(text));
    } catch (const Error&) {
        return;
    }
    if (to_json(from_json(canonical)) != canonical) throw std::logic_error("canonical text does not come back");
}

void read(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    read_with(graph_from_json, text);
    read_with(plan_from_json, text);
    read_with(hosts_from_json, text);
    read_with(job_from_json, text);
    if (const auto figures = figures_from(text); figures && figures_from(to_text(*figures)) != figures)
        throw std::logic_error("figures do not come back");
}

Graph graph() {
    Graph graph;
    graph.file = "box.lua";
    graph.nodes = {{"scene", "Scene", {Value{std::string("box.pbrt")}}, {}, {"box.lua", 1}},
                   {"direct", "DirectLighting", {}, {{"samples", Value{4.0}}, {"fast", Value{true}}}, {"box.lua", 2}},
                   {"image",
                    "RayTracer",
                    {Value{NodeRef{"direct"}}},
                    {{"film", Value{Table{{Value{8.0}, Value{4.0}}, {{"file", Value{std::string("x.exr")}}}}}}},
                    {"box.lua", 3}}};
    return graph;
}

std::vector<std::string> seeds() {
    const Plan plan{{{"tcp://onyx1:7777", 0}, {"", 1}}, {{0, 1}, {}, {1}}};
    const Hosts hosts{"lab.lua", {{"tcp://onyx1:7777", {{"direct", 2}}, 3, {"lab.lua", 1}}}};
    Job job;
    job.graph = graph();
    job.scene = "box.pbrt";
    job.files = {{"box.pbrt", content_hash(std::string("x")), 1}};
    job.isa = "avx2";
    return {to_json(graph()), to_json(plan), to_json(hosts), to_json(job),
            to_text(HostFigures{{{1, 2, 3, 4}}, {{5, 6, 7, 8, 9, 10, 11}}, {{12, 1, 2, 3}, {13}}})};
}

}  // namespace

Target texts() { return {"texts", read, seeds}; }

}  // namespace lightnet::fuzz
