// What it costs to keep groups of lamps apart: the same network over the same eight lamps, once with a layer for each
// group and once without, in turns.
// Arguments: paths, maps; without any, both.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/stage.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::bench {
namespace {

namespace fs = std::filesystem;

constexpr int lamps = 7;  // each a group, and the rest is the eighth: the sky
const int rounds = repeated(5);

// The room of graphs/studio.pbrt, with seven lamps below its ceiling instead of its own three.
std::string scene_text() {
    std::ifstream in(fs::path(LIGHTNET_SOURCE_DIR) / "graphs/studio.pbrt");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.resize(text.find("# A lamp is called"));
    for (int i = 0; i < lamps; ++i) {
        const std::string x = std::to_string(-1.8 + 0.55 * i), wide = std::to_string(-1.5 + 0.55 * i);
        text += "AttributeBegin\nAttribute \"light\" \"string name\" \"lamp" + std::to_string(i + 1) +
                "\"\nAreaLightSource \"diffuse\" \"rgb L\" [ 9 8 7 ]\nNamedMaterial \"plaster\"\n"
                "Shape \"trianglemesh\" \"point3 P\" [ " +
                x + " 2.9 -2 " + wide + " 2.9 -2 " + wide + " 2.9 0 " + x +
                " 2.9 0 ] \"integer indices\" [ 0 1 2 0 2 3 ]\nAttributeEnd\n";
    }
    return text;
}

std::string graph_text(const std::string& operators, bool apart, const std::string& film) {
    std::string groups;
    for (int i = 1; i <= lamps; ++i) groups += "g" + std::to_string(i) + " = 'lamp" + std::to_string(i) + "', ";
    return std::string("apart = ") + (apart ? "true" : "false") + "\nscene = Scene { 'room.pbrt', groups = { " +
           groups + "} }\n" + operators + "\nimage = RayTracer { lighting, groups = apart, scene = scene, " + film +
           " }\n";
}

const std::string paths =
    "direct = DirectLighting { groups = apart }\nbounce = PathTracing { groups = apart }\n"
    "lighting = Combine { direct, bounce }";
// Figure 5's.
const std::string maps =
    "direct = DirectLighting { groups = apart }\n"
    "caustics = PhotonMap { groups = apart, paths = 'caustic', photons = 100000, gather = 50 }\n"
    "global = PhotonMap { groups = apart, paths = 'diffuse', photons = 100000, gather = 50 }\n"
    "first = Combine { direct, caustics, global }\n"
    "soft = IrradianceCache { first, groups = apart, rays = 384, glossy_rays = 4, error = 0.0625 }\n"
    "lighting = Combine { direct, caustics, soft }";

void measure(const Registry& registry, const std::string& name, const std::string& operators, const std::string& film) {
    const test::Folder folder;
    folder.write("room.pbrt", scene_text());
    const auto stage = [&](bool apart) {
        return Stage(registry, parse_graph(graph_text(operators, apart, film), folder.file("room.lua")));
    };
    Stage apart = stage(true), together = stage(false);
    std::vector<double> ratios;
    for (int round = 0; round < rounds; ++round) {
        const double with = apart.in_threads(1).cpu_seconds, without = together.in_threads(1).cpu_seconds;
        std::printf("  %s: %.2f s of the processor with eight groups, %.2f s without\n", name.c_str(), with, without);
        ratios.push_back(with / without);
    }
    quantity("groups." + name, ratios, "times", 1.25, false);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    namespace bench = lightnet::bench;
    const auto wanted = [&](std::string_view group) {
        return argc == 1 || std::any_of(argv + 1, argv + argc, [&](const char* word) { return group == word; });
    };
    return bench::run("groups", [&] {
        const lightnet::Registry registry{lightnet::standard_nodes()};
        const std::string film = bench::sized<std::string>("samples = 16, film = { 160, 120, file = 'x.exr' }",
                                                           "samples = 1, film = { 16, 12, file = 'x.exr' }");
        if (wanted("paths")) bench::measure(registry, "paths", bench::paths, film);
        if (wanted("maps")) bench::measure(registry, "maps", bench::maps, film);
    });
}
