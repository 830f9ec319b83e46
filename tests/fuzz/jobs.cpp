#include <stdexcept>

#include "core/base/error.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/job.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/fuzz/targets.hpp"

namespace lightnet::fuzz {
namespace {

const Registry& registry() {
    static const Registry registry{standard_nodes()};
    return registry;
}

void read(std::span<const std::byte> bytes) {
    Job job;
    try {
        job = read_job({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, registry());
    } catch (const Error&) {
        return;
    }
    if (read_job(to_json(job), registry()) != job) throw std::logic_error("a job does not come back");
    const auto layers = layers_of(job.graph, registry());
    if (!fits(plan(job.graph, registry(), {}, {{"tcp://a:1", 2}}), job.graph) || layers.film.empty())
        throw std::logic_error("a sound graph can't be laid out");
}

Node node(const std::string& name, const std::string& kind, List entries, std::map<std::string, Value> params = {}) {
    return {name, kind, std::move(entries), std::move(params), {"box.lua", 1}};
}

Job job_of(std::vector<Node> nodes) {
    Job job;
    job.graph = {"box.lua", std::move(nodes)};
    job.scene = "box.pbrt";
    job.files = {{"box.pbrt", content_hash(std::string_view("x")), 1}};
    job.isa = "avx2";
    job.width = 8, job.height = 4;
    return job;
}

std::vector<std::string> seeds() {
    const Node scene = node("scene", "Scene", {Value{std::string("box.pbrt")}});
    const Value film{Table{{Value{8.0}, Value{4.0}}, {}}};
    const auto image = [&](const std::string& input) {
        return node("image", "RayTracer", {Value{NodeRef{input}}},
                    {{"scene", Value{NodeRef{"scene"}}}, {"film", film}});
    };
    const Job small = job_of({scene, node("direct", "DirectLighting", {}, {{"samples", Value{4.0}}}), image("direct")});
    Job large = job_of({scene, node("direct", "DirectLighting", {}), node("caustics", "PhotonMap", {}),
                        node("first", "Combine", {Value{NodeRef{"direct"}}, Value{NodeRef{"caustics"}}}),
                        node("bounce", "IrradianceCache", {Value{NodeRef{"first"}}}),
                        node("all", "Combine", {Value{NodeRef{"first"}}, Value{NodeRef{"bounce"}}}), image("all")});
    large.graph = sharded(std::move(large.graph), {{"caustics", 3}});
    return {to_json(small), to_json(large)};
}

}  // namespace

Target jobs() { return {"jobs", read, seeds}; }

}  // namespace lightnet::fuzz
