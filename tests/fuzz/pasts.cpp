// What earlier runs have left: files that keep what they learnt, recipes, reports; and what a launcher says of a run.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "core/run/assembly/kept.hpp"
#include "lua/custom.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/fuzz/targets.hpp"
#include "tools/explain/past_run.hpp"
#include "tools/watch/run_table.hpp"
#include "transport/store/recipes.hpp"

namespace lightnet::fuzz {
namespace {

namespace fs = std::filesystem;

std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

const Registry& registry() {
    static const Registry all = [] {
        Registry made{standard_nodes()};
        made.add({custom_kind()});
        return made;
    }();
    return all;
}

/// A folder of this process.
const fs::path& folder() {
    static const auto path = [] {
        auto made = fs::temp_directory_path() / ("lightnet-fuzz-past-" + std::to_string(getpid()));
        fs::create_directories(made);
        return made;
    }();
    return path;
}

const Kind& keeper() { return *registry().find("PhotonMap"); }

void read_kept_file(std::span<const std::byte> bytes) {
    try {
        (void)kept_results(keeper(), content_hash("scene"), bytes);
    } catch (const Error&) {
    }
    const Hash recipe = content_hash("recipe");
    std::ofstream(folder() / to_hex(recipe), std::ios::binary) << text_of(bytes);
    (void)read_recipe(folder(), recipe);
}

std::vector<std::string> kept_seeds() {
    const std::string results = "some results";
    const Hash recipe = content_hash("recipe");
    write_recipe(folder(), recipe, content_hash("blob"));
    std::ifstream in(folder() / to_hex(recipe), std::ios::binary);
    return {kept_text(keeper(), content_hash("scene"), std::as_bytes(std::span(results))),
            {std::istreambuf_iterator<char>(in), {}}};
}

void read_past(std::span<const std::byte> bytes) {
    const auto file = folder() / "x.run.json";
    std::ofstream(file, std::ios::binary) << text_of(bytes);
    try {
        (void)read_past_run(file, registry());
    } catch (const UserError&) {
    } catch (const Error&) {
    }
    try {
        (void)to_text(table_of_report(text_of(bytes)), 80, 24);
    } catch (const Error&) {
    }
}

std::vector<std::string> past_seeds() {
    return {R"({"settings":{"seed":"7"},"graph":{"file":"g.lua","folder":"","network":{"file":"g.lua","nodes":[
{"name":"scene","kind":"Scene","entries":["s.pbrt"],"params":{}},{"name":"d","kind":"DirectLighting","entries":[],"params":{}},
{"name":"image","kind":"RayTracer","entries":[{"node":"d"}],"params":{"scene":{"node":"scene"},"film":{"list":[8,8],"named":{"file":"o.exr"}}}}]}},
"state":"done","seconds":1.5,"counters":{"rays":12,"not_finite.d":3},"hosts":[{"name":"a","state":"ready","places":1}],
"places":[{"host":"a","index":0,"nodes":["d"]}],"nodes":[]})"};
}

// A line each.
void hear_all(std::span<const std::byte> bytes) {
    LiveTable table;
    const std::string text = text_of(bytes);
    for (std::size_t at = 0; at <= text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        try {
            table.hear(text.substr(at, end - at));
        } catch (const Error&) {
        }
        at = end + 1;
    }
    try {
        (void)to_text(table.table(), 80, 24);
        (void)table.outcome();
    } catch (const Error&) {
    }
}

std::vector<std::string> word_seeds() {
    return {R"({"hello":{"graph":{"file":"g.lua","nodes":[{"name":"d","kind":"DirectLighting"}]},"width":8,"height":8}}
{"state":{"done":0.5,"seconds":2,"left":1e300,"hosts":[{"name":"a","state":"serves","places":2,"answered":7,"figures":{}}],"nodes":[]}}
{"line":"a host has joined"}
{"did":"drain","allowed":true}
{"over":"done"})"};
}

}  // namespace

Target kept() { return {"kept", read_kept_file, kept_seeds}; }
Target pasts() { return {"pasts", read_past, past_seeds}; }
Target words() { return {"words", hear_all, word_seeds}; }

}  // namespace lightnet::fuzz
