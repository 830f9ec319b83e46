// How long pictures take until they are good: prepared and rendered with two places, beside reference pictures. The
// references are not part of the project: LIGHTNET_SHARED names the folder that has them under reference/. Goals are
// seconds of one machine; bare Embree tells, before and after each row, how fast this one is beside it.
// Arguments: names of rows; without any, all of them. LIGHTNET_BENCH_SAMPLES changes the samples per pixel of rows that
// have no bias.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/machine.hpp"
#include "tests/bench/stage.hpp"
#include "transport/start/local_workers.hpp"

namespace lightnet::bench {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::uint32_t places = 2;
constexpr double target = 1e-3;  // mean of d² / (reference² + 0.01)

using Constants = std::map<std::string, std::string>;

/// A line of the table: what is rendered, what it is compared with, and within how many seconds it should be good.
struct Row {
    std::string name, graph, scene, reference;
    Constants constants;  // of the graph; path_all.lua follows four paths for each sample
    bool biased;          // noise doesn't fall in proportion to time: the picture has to be good as it is
    double noise;         // of the reference itself, in the same measure; subtracted
    double goal;          // seconds, on the machine of machine.hpp
};

const std::vector<Row>& rows() {
    static const std::string grey = "cornell_grey.mits_path_2048.exr", indirect = "indirect.mits_path_2048.exr",
                             caustic = "caustic.mits_bdpt_1280.exr";
    // What is just good enough.
    static const Constants quick_cache{{"rays", "128"}, {"samples", "8"}};
    static const Constants quick_map{{"photons", "100000"}, {"rays", "128"}, {"samples", "12"}};
    static const Constants quick_passes{{"passes", "64"}, {"photons", "120000"}};
    static const std::vector<Row> table{
        {"cornell_grey", "path_all.lua", "cornell_grey.pbrt", grey, {}, false, 0, 3.5},
        {"indirect", "path_all.lua", "indirect.pbrt", indirect, {}, false, 6e-4, 40},
        {"terrain", "path_all.lua", "terrain.pbrt", "terrain.combined.exr", {}, false, 0, 5},
        {"cornell_grey_layers", "path.lua", "cornell_grey.pbrt", grey, {{"samples", "64"}}, false, 0, 3.5},
        {"indirect_cache", "irradiance_cache.lua", "indirect.pbrt", indirect, quick_cache, true, 6e-4, 0.8},
        {"cornell_grey_cache", "irradiance_cache.lua", "cornell_grey.pbrt", grey, quick_cache, true, 0, 0.7},
        {"caustic_map_cache", "figure5.lua", "caustic.pbrt", caustic, quick_map, true, 6e-4, 5},
        {"caustic_progressive", "progressive.lua", "caustic.pbrt", caustic, quick_passes, true, 6e-4, 12},
    };
    return table;
}

/// What runs on two daemons of one place should take no longer than in two threads.
struct NetworkedRow {
    std::string name, graph;
    Constants constants;  // as many samples as make it a job of 10 to 20 s; all else as the graph has it
};

const std::vector<NetworkedRow>& networked_rows() {
    static const std::vector<NetworkedRow> table{
        {"networked_path", "path_all.lua", {{"samples", "160"}}},
        {"networked_cache", "irradiance_cache.lua", {{"samples", "960"}}},
        {"networked_map_cache", "figure5.lua", {{"samples", "960"}}},
    };
    return table;
}

void measure(const Row& row, const fs::path& folder, const Registry& registry, const Machine& machine) {
    Constants constants = row.constants;
    constants["file"] = (folder / row.scene).string();
    if (const char* samples = std::getenv("LIGHTNET_BENCH_SAMPLES"); samples && !row.biased)
        constants["samples"] = samples;
    Stage stage(registry, row.graph, constants);
    const double before = machine.speed();
    const Rendered made = stage.in_threads(places);
    const double speed = (before + machine.speed()) / 2;
    const Difference found = compare(read_exr(folder / row.reference), made.picture);
    const double error = std::max(0.0, found.relative_square - row.noise);
    std::printf(
        "  %s: %u samples per pixel in %.2f s, %.2f s of them to prepare (%.2f s of work per place; %.2f s to build "
        "the "
        "scene), %.2f M samples/s, %.2f M rays/s, %.2f rays per sample, relative square %.3g, mean %.4f\n",
        row.name.c_str(), stage.samples_per_pixel(), made.seconds, made.preparing, made.cpu_seconds / places,
        stage.building(), stage.samples() / made.seconds * 1e-6, made.rays / made.seconds * 1e-6,
        made.rays / stage.samples(), found.relative_square, found.mean_ratio.g);
    for (const auto& line : made.said) std::printf("  %s: %s\n", row.name.c_str(), line.c_str());
    // Noise falls as samples grow: what it would take until it is at the target.
    const double part = row.biased ? 1 : error / target;
    std::printf("  %s: %.2f s of work per place to %g\n", row.name.c_str(), made.cpu_seconds / places * part,
                row.biased ? error : target);
    const double seconds = made.seconds * part, scaled = seconds * speed;
    std::printf("  %s: %.2f s here, where bare Embree has %.2f of the speed for which the goal holds\n",
                row.name.c_str(), seconds, speed);
    const bool good = scaled <= row.goal && (!row.biased || error <= target);
    std::printf("render.%s %.2fs%s <=%gs %s\n", row.name.c_str(), scaled,
                row.biased && error > target ? ", but not good" : "", row.goal, good ? "ok" : "short");
    std::fflush(stdout);
}

/// Warm daemons: they have the scene, as a run before this one brought it.
void measure_networked(const NetworkedRow& row, const fs::path& folder, const Registry& registry) {
    constexpr int rounds = 5;
    Constants constants = row.constants;
    constants["file"] = (folder / "cornell_grey.pbrt").string();
    Stage stage(registry, row.graph, constants);
    const LocalWorkers workers(LIGHTNET_DAEMON, 2, 1);
    std::uint64_t run = 0;
    const auto networked = [&] {
        Cluster cluster(stage.options(workers.endpoints(), ++run));
        const std::atomic<bool> never{false};
        cluster.gather(20s, never);
        cluster.adopt(cluster.plan());
        const Rendered made = stage.on(cluster, run);
        cluster.finish();
        return made;
    };
    std::vector<double> more;
    for (int round = 0; round < rounds; ++round) {
        // Each goes first in turn, so that a machine that gets slower or faster favours nobody.
        std::array<Rendered, 2> made;
        for (int turn = 0; turn < 2; ++turn)
            if ((turn + round) % 2 == 0)
                made[0] = stage.in_threads(places);
            else
                made[1] = networked();
        std::printf("  %s: %.2f s in threads (%.2f to prepare), %.2f s on daemons (%.2f)\n", row.name.c_str(),
                    made[0].seconds, made[0].preparing, made[1].seconds, made[1].preparing);
        more.push_back(made[1].seconds / made[0].seconds - 1);
    }
    figure(("render." + row.name).c_str(), median(more), 0.01, false);
}

void measure_all(const std::vector<std::string>& names) {
    const char* shared = std::getenv("LIGHTNET_SHARED");
    const fs::path folder = fs::path(shared ? shared : "") / "reference";
    if (!shared || !fs::exists(folder)) {
        std::printf("  the reference pictures are not here: LIGHTNET_SHARED names the folder above reference/\n");
        return;
    }
    const Registry registry{standard_nodes()};
    const auto wanted = [&](const std::string& name) {
        return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    };
    const Machine machine(folder / "terrain.ply");
    for (const Row& row : rows())
        if (wanted(row.name)) measure(row, folder, registry, machine);
    for (const NetworkedRow& row : networked_rows())
        if (wanted(row.name)) measure_networked(row, folder, registry);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    return lightnet::bench::run("render", [&] { lightnet::bench::measure_all({argv + 1, argv + argc}); });
}
