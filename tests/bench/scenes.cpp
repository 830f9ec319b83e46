// What scenes of every kind cost: those that have a reference picture, by path tracing and by the network of figure 5.
// Each is measured in a process of its own, so that its memory is its own. Pictures are made by two places with three
// seeds, scenes read and built anew each time. What is a figure with a goal is the share of bare Embree's rate that
// path tracing has with the scene's own rays (bare_embree.hpp).
// Arguments: names of scenes; without any, all of them. LIGHTNET_BENCH_SAMPLES changes the samples per pixel,
// LIGHTNET_BENCH_ONLY=shares leaves out the pictures.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "core/readers/read_scene.hpp"
#include "core/scene/scene.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/bare_embree.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/scene_files.hpp"
#include "tests/bench/stage.hpp"

namespace lightnet::bench {
namespace {

constexpr std::uint32_t places = 2;
const std::uint64_t seeds = sized<std::uint64_t>(3, 1);
const std::size_t rounds = sized<std::size_t>(3, 1);
constexpr double mib = 1 << 20;

using Constants = std::map<std::string, std::string>;

/// What renders, and how long it may take.
struct Way {
    std::string name, graph;
    Constants constants;
    bool biased;  // its error doesn't fall in proportion to its time
};

const std::array<Way, 2>& ways() {
    static const std::array<Way, 2> both{
        Way{"path", "path.lua", {}, false},
        Way{"figure5",
            "paper/figure5.lua",
            {{"samples", "12"}, {"photons", "150000"}, {"rays", "192"}, {"wanted_error", "0.0625"}},
            true}};
    return both;
}

void make_small(Constants& constants) {
    if (!smoke()) return;
    for (const auto& [name, value] : Constants{{"samples", "1"}, {"photons", "2000"}, {"rays", "16"}})
        if (constants.contains(name)) constants[name] = value;
}

// The most memory that this process has had since it was asked to forget, bytes.
void forget_peak() { std::ofstream("/proc/self/clear_refs") << 5; }
double peak() {
    std::ifstream in("/proc/self/status");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("VmHWM:")) return 1024 * std::atof(line.c_str() + 6);
    return 0;
}

void show_spread(const char* name, const std::vector<double>& values) {
    const Spread spread(values);
    std::printf(" %s %.3g [%.3g %.3g]", name, spread.middle, spread.least, spread.greatest);
}

/// The scene alone, as one thread reads it and all cores build it.
void measure_loading(const ReferenceScene& row, const SceneFiles& files) {
    std::vector<double> reading, building;
    SceneSize size;
    for (std::uint64_t round = 0; round < seeds; ++round) {
        SceneData data;
        reading.push_back(seconds_of([&] {
            DiskFiles disk;
            data = read_scene(disk, files.main().string());
        }));
        building.push_back(seconds_of([&] { size = Scene(std::move(data)).size(); }));
    }
    const double triangles = double(std::max<std::size_t>(1, size.triangles));
    std::printf("  %s:", row.name.c_str());
    show_spread("s to read", reading);
    show_spread("s to build", building);
    std::printf("; %zu triangles, %.0f bytes each (%.0f of trees), %.1f MiB of textures, %.1f MiB of %zu lights\n",
                size.triangles, double(size.shape_bytes + size.tree_bytes) / triangles,
                double(size.tree_bytes) / triangles, double(size.texture_bytes) / mib, double(size.light_bytes) / mib,
                size.lights);
}

void measure_pictures(const ReferenceScene& row, const Way& way, Constants constants,
                      const lightnet::Picture& reference, const Registry& registry) {
    constants.merge(Constants(way.constants));
    constants.try_emplace("samples", std::to_string(row.samples));
    make_small(constants);
    forget_peak();
    Stage stage(registry, way.graph, constants);
    std::vector<double> errors, trimmed, means, to_target, with_loading, rates, preparing;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        stage.use_seed(seed);
        const Rendered made = stage.in_threads(places);
        const Difference found = compare(reference, made.picture);
        errors.push_back(std::max(0.0, found.relative_square - row.noise));
        trimmed.push_back(found.relative_square_trimmed);
        means.push_back(found.mean_ratio.g);
        to_target.push_back(way.biased ? made.seconds : made.seconds * errors.back() / row.target);
        with_loading.push_back(made.building + to_target.back());
        rates.push_back(made.rays / made.seconds * 1e-6);
        preparing.push_back(made.preparing);
    }
    std::printf("  %s.%s:", row.name.c_str(), way.name.c_str());
    show_spread("error", errors);
    std::printf(" with %u samples;", stage.samples_per_pixel());
    if (way.biased)
        show_spread("s to that picture", to_target);
    else
        show_spread(("s to an error of " + std::to_string(row.target).substr(0, 5)).c_str(), to_target);
    show_spread("with loading", with_loading);
    show_spread("of it preparing", preparing);
    show_spread("M rays/s", rates);
    show_spread("error without the worst thousandth", trimmed);
    show_spread("mean", means);
    std::printf(" peak %.0f MiB\n", peak() / mib);
}

void measure_share(const ReferenceScene& row, const Way& way, Constants constants, const Registry& registry) {
    constants.merge(Constants(way.constants));
    const bool path = !way.biased;
    constants["samples"] = "1";
    make_small(constants);
    const auto found = beside_bare_embree(registry, path ? "path_all.lua" : way.graph, constants, rounds);
    const std::string name = "scenes." + row.name + (path ? "" : "." + way.name);
    if (!found) return not_run(name, "it wants Embree 3");
    std::printf("  %s: %.2f M rays/s of work in a whole serial render, %.2f M rays/s in the bare loop", name.c_str(),
                median(found->whole_rates), median(found->bare_rates));
    if (!path) show_spread("; share", found->shares);
    std::printf("\n");
    if (path) figure(name, found->shares, row.share, true);
}

void measure(const ReferenceScene& row, const Registry& registry) {
    const SceneFiles files(row);
    if (files.missing()) return not_run("scenes." + row.name, *files.missing());
    const lightnet::Picture reference = read_exr(files.reference());
    const auto size = [&](std::uint32_t divided) {
        return Constants{{"file", files.main().string()},
                         {"width", std::to_string(reference.width / divided)},
                         {"height", std::to_string(reference.height / divided)}};
    };
    Constants whole = size(1);
    if (const char* samples = std::getenv("LIGHTNET_BENCH_SAMPLES")) whole["samples"] = samples;
    const char* only = std::getenv("LIGHTNET_BENCH_ONLY");
    if (!only) {
        measure_loading(row, files);
        for (const Way& way : ways()) measure_pictures(row, way, whole, reference, registry);
    }
    for (const Way& way : ways())
        if (!only || !way.biased) measure_share(row, way, size(2), registry);
}

/// In a process of its own. What goes wrong there is said, and the others go on.
void measure_apart(const ReferenceScene& row) {
    std::fflush(stdout);
    const pid_t process = fork();
    if (process == 0) {
        int status = 0;
        try {
            measure(row, Registry{standard_nodes()});
        } catch (const std::exception& error) {
            broken("scenes." + row.name, error.what());
        } catch (...) {
            status = 1;
        }
        std::fflush(stdout);
        _exit(status);
    }
    int status = 0;
    if (process < 0 || waitpid(process, &status, 0) != process || status != 0)
        broken("scenes." + row.name, "its process was lost");
}

void measure_all(const std::vector<std::string>& names) {
    for (const ReferenceScene& row : reference_scenes())
        if (names.empty() || std::find(names.begin(), names.end(), row.name) != names.end()) measure_apart(row);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    return lightnet::bench::run("scenes", [&] { lightnet::bench::measure_all({argv + 1, argv + argc}); });
}
