// How much of a rendering is tracing rays: a whole serial render by PathTracing beside a bare loop over Embree that
// traces the same packets of rays (bare_embree.hpp).
// Arguments: samples per pixel (4); scene files, instead of the Cornell box and the terrain.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "nodes/standard_nodes.hpp"
#include "tests/bench/bare_embree.hpp"
#include "tests/bench/figure.hpp"
#include "tests/support/references.hpp"

namespace lightnet::bench {
namespace {

const std::size_t rounds = sized<std::size_t>(7, 1);

/// Of a scene file; empty: of the one that the graph names.
void measure(const std::string& name, const std::string& scene, const Registry& registry, int samples) {
    std::map<std::string, std::string> constants{
        {"width", "128"}, {"height", "128"}, {"samples", std::to_string(samples)}};
    if (!scene.empty()) constants["file"] = std::filesystem::absolute(scene).string();
    const auto found = beside_bare_embree(registry, "path_all.lua", constants, rounds);
    if (!found) return not_run(name, "it wants Embree 3");
    std::printf("  %s: %.2f M rays/s of work in a whole render, %.2f M rays/s in the bare loop, %.2f M ray by ray\n",
                name.c_str(), median(found->whole_rates), median(found->bare_rates), median(found->single_rates));
    figure(name, found->shares, 0.6, true);
}

void measure_all(const std::vector<std::string>& arguments) {
    const Registry registry{standard_nodes()};
    int samples = 4;
    std::vector<std::filesystem::path> scenes;
    for (const auto& argument : arguments)
        if (const int number = std::atoi(argument.c_str()); number > 0)
            samples = number;
        else
            scenes.emplace_back(argument);
    for (const auto& scene : scenes) measure("embree." + scene.stem().string(), scene.string(), registry, samples);
    if (!scenes.empty()) return;
    measure("embree.cornell", "", registry, samples);
    if (const auto terrain = test::reference_file("terrain.pbrt"))
        measure("embree.terrain", terrain->string(), registry, samples);
    else
        not_run("embree.terrain", test::is_not_here("reference/terrain.pbrt"));
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    return lightnet::bench::run("embree", [&] { lightnet::bench::measure_all({argv + 1, argv + argc}); });
}
