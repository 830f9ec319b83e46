#include <lua_any.hpp>

#include <stdexcept>

#include "core/base/error.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/light_paths.hpp"
#include "core/network/graph/plan.hpp"
#include "lua/graph_script.hpp"
#include "lua/hosts_script.hpp"
#include "lua/sandbox.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/fuzz/targets.hpp"

namespace lightnet::fuzz {
namespace {

const Registry& registry() {
    static const Registry registry{standard_nodes()};
    return registry;
}

// In the child that runs such files a clock ends them. Here it is the number of steps, the same each time.
void give_up(lua_State* state, lua_Debug*) { luaL_error(state, "too many steps"); }

template <class Script>
auto run(const std::string& text) {
    lua::Sandbox sandbox("graph.lua", std::size_t{4} << 20);
    lua_sethook(sandbox.state(), give_up, LUA_MASKCOUNT, 20000);
    LuaOptions options;
    options.constants = {{"size", "8"}};
    Script script(sandbox, options);
    sandbox.run(text);
    return script.finish();
}

void read_graph(const std::string& text) {
    const Graph graph = run<lua::GraphScript>(text);
    if (graph_from_json(to_json(graph)) != graph) throw std::logic_error("a graph does not come back");
    const Examined found = examine(graph, registry());
    if (found.problems.empty()) (void)layers_of(found.graph, registry());
}

void read_hosts(const std::string& text) {
    const Hosts hosts = run<lua::HostsScript>(text);
    if (hosts_from_json(to_json(hosts)) != hosts) throw std::logic_error("hosts do not come back");
}

void read(std::span<const std::byte> bytes) {
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const auto& attempt : {read_graph, read_hosts}) try {
            attempt(text);
        } catch (const UserError&) {
        } catch (const Error&) {
        }
}

std::vector<std::string> seeds() {
    return {
        R"(size, n = 8, 3
scene = Scene { "box.pbrt", exposure = 1, environment = { 1, .5, .25 } }
direct = DirectLighting { samples = 4 }
for i = 1, n do _ENV["n" .. i] = Scale { direct, factor = i } end
all = Combine { n1, n2, later, weights = { 1, 2, .5 } }
later = PathTracing {}
image = RayTracer { all, scene = scene, samples = 16, film = { size, size, file = "x.exr" }, show = { direct } }
)",
        R"(photons = PhotonMap { photons = 1e4, paths = "caustic" }
both = Combine { photons, FinalGather { photons, rays = 4 } }
bounce = IrradianceCache { both, rays = 16 }
scene = Scene { 'a.xml', camera = { from = { 0, 1, 2 }, fov = 40 }, constants = { a = 1, b = "c", d = true } }
local t = setmetatable({}, { __index = function(t, k) return k end })
image = RayTracer { bounce, scene = scene, film = { 4, 4, crop = { 0, 0, 2, 2 } } }
)",
        R"(scene = Scene { "box.pbrt", fog = { density = .1 }, groups = { key = "spot" } }
direct = DirectLighting { groups = true }
walls, air = Select { direct, where = "surfaces" }, DirectLighting {}
fog = Select { air, where = "media" }
light = Combine { walls, fog, PathTracing {} }
image = RayTracer { light, scene = scene, film = { 4, 4 }, groups = true,
                    layers = { once = "CS*V<L.'key'>", lit = { "C[SD]*DO", "CB|<.S>" }, more = "CS*[DV].{1,3}L?" } }
)",
        R"(strategy = "affinity"
place "tcp://onyx1:7777" { direct = 1, caustics = 2, places = 4 }
place "onyx2" {}
strategy { bounce = "affinity" }
layout { caustics = "sharded" }
)"};
}

}  // namespace

Target graphs() { return {"graphs", read, seeds}; }

}  // namespace lightnet::fuzz
