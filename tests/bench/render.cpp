// How long pictures take until they are good, from the files of the scene on: its tree built, all prepared and rendered
// with two places, beside reference pictures (references.hpp). Goals are seconds of one machine; bare Embree tells,
// before and after each picture, how fast this one is beside it.
// Rows without bias are rendered with three seeds, and their noise tells how long they would take to the target. Rows
// with a bias have to be good as they are, with 15 of 16 seeds, or they have no figure that counts. Nobody can choose
// parameters that please these seeds: they follow from the commit (LIGHTNET_BENCH_COMMIT, which ./bench sets).
// Arguments: names of rows; without any, all of them. LIGHTNET_BENCH_SAMPLES changes the samples per pixel of rows that
// have no bias.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/machine.hpp"
#include "tests/bench/stage.hpp"
#include "tests/support/references.hpp"
#include "transport/start/local_workers.hpp"

namespace lightnet::bench {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::uint32_t places = 2;
constexpr double target = 1e-3;  // mean of d² / (reference² + 0.01)
constexpr double most_off = 0.01, most_off_in_blocks = 0.03;
const std::uint64_t seeds_without_bias = sized(3u, 1u), seeds_with_bias = sized(16u, 1u);
constexpr std::uint64_t most_bad = 1;

using Constants = std::map<std::string, std::string>;

/// A line of the table: what is rendered, what it is compared with, and within how many seconds it should be good.
struct Row {
    std::string name, graph, scene, reference;
    Constants constants;  // of the graph
    bool biased;          // noise doesn't fall in proportion to time: the picture has to be good as it is
    double noise;         // of the reference itself, in the same measure; subtracted
    double goal;          // seconds, on the machine of machine.hpp
};

const std::vector<Row>& rows() {
    static const std::string grey = "cornell_grey.mits_path_2048.exr", indirect = "indirect.mits_path_2048.exr",
                             caustic = "caustic.mits_bdpt_1280.exr", terrain = "terrain.combined.exr";
    static const Constants many_samples{{"samples", "64"}};
    // What is just good enough.
    static const Constants quick_cache{{"rays", "128"}, {"samples", "8"}, {"wanted_error", "0.0625"}};
    static const Constants dark_room_cache{{"rays", "1536"}, {"samples", "8"}, {"wanted_error", "0.0625"}};
    static const Constants quick_map{
        {"photons", "150000"}, {"rays", "192"}, {"samples", "12"}, {"wanted_error", "0.0625"}};
    static const Constants quick_passes{{"samples", "64"}, {"photons", "120000"}};
    static const std::vector<Row> table{
        {"cornell_grey", "path.lua", "cornell_grey.pbrt", grey, many_samples, false, 0, 2.2},
        {"indirect", "path.lua", "indirect.pbrt", indirect, many_samples, false, 6e-4, 22},
        {"terrain", "path.lua", "terrain.pbrt", terrain, many_samples, false, 0, 2.5},
        {"cornell_grey_one_node", "path_all.lua", "cornell_grey.pbrt", grey, {}, false, 0, 2.2},
        {"indirect_one_node", "path_all.lua", "indirect.pbrt", indirect, {}, false, 6e-4, 22},
        {"indirect_guided", "guided.lua", "indirect.pbrt", indirect, {}, false, 6e-4, 11},
        {"terrain_one_node", "path_all.lua", "terrain.pbrt", terrain, {}, false, 0, 2.5},
        {"indirect_cache", "irradiance_cache.lua", "indirect.pbrt", indirect, dark_room_cache, true, 6e-4, 0.8},
        {"cornell_grey_cache", "irradiance_cache.lua", "cornell_grey.pbrt", grey, quick_cache, true, 0, 0.7},
        {"caustic_map_cache", "paper/figure5.lua", "caustic.pbrt", caustic, quick_map, true, 6e-4, 5},
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
        {"networked_map_cache", "paper/figure5.lua", {{"samples", "960"}}},
    };
    return table;
}

/// The seed that is the `index`-th of this commit. Where no commit is known, those of one that is stated here.
std::uint64_t seed_of(std::uint64_t index) {
    const char* const commit = std::getenv("LIGHTNET_BENCH_COMMIT");
    return child(key_of(commit && *commit ? commit : "no commit"), index) >> 1;  // a seed of the command line, too
}

bool is_good(const Difference& found, double error) {
    const Rgb& mean = found.mean_ratio;
    const double off =
        std::max({std::abs(double{mean.r} - 1), std::abs(double{mean.g} - 1), std::abs(double{mean.b} - 1)});
    return error <= target && off <= most_off && found.block_difference <= most_off_in_blocks;
}

/// Files of a row; none: it can't be run here.
struct RowFiles {
    fs::path scene, reference;
};
std::optional<RowFiles> files_of(const Row& row) {
    for (const auto& name : {row.scene, row.reference})
        if (!test::reference_file(name)) {
            not_run("render." + row.name, test::is_not_here("reference/" + name));
            return std::nullopt;
        }
    return RowFiles{*test::reference_file(row.scene), *test::reference_file(row.reference)};
}

void measure(const Row& row, const Registry& registry, const Machine& machine) {
    const auto files = files_of(row);
    if (!files) return;
    Constants constants = row.constants;
    constants["file"] = files->scene.string();
    if (const char* samples = std::getenv("LIGHTNET_BENCH_SAMPLES"); samples && !row.biased)
        constants["samples"] = samples;
    if (smoke())
        for (const auto& [name, value] : Constants{{"samples", "1"}, {"photons", "2000"}, {"rays", "16"}})
            if (name == "samples" || constants.contains(name)) constants[name] = value;
    Stage stage(registry, row.graph, constants);
    const auto reference = read_exr(files->reference);
    std::printf("  %s: %s with %u samples per pixel\n", row.name.c_str(), row.graph.c_str(), stage.samples_per_pixel());
    std::vector<double> scaled;
    std::uint64_t good = 0;
    const std::uint64_t seeds = row.biased ? seeds_with_bias : seeds_without_bias;
    double before = machine.speed();
    for (std::uint64_t index = 0; index < seeds; ++index) {
        const std::uint64_t seed = seed_of(index);
        stage.use_seed(seed);
        const Rendered made = stage.in_threads(places);
        const double after = machine.speed(), speed = (before + after) / 2;
        before = after;
        const Difference found = compare(reference, made.picture);
        const double error = std::max(0.0, found.relative_square - row.noise);
        good += is_good(found, error);
        // Noise falls as samples grow: what it would take until it is at the target.
        const double seconds = made.building + made.seconds * (row.biased ? 1 : error / target);
        std::printf(
            "  seed %llu: %.2f s to build the scene, %.2f s to prepare, %.2f s to render (%.2f s of work per place), "
            "%.2f M samples/s, %.2f M rays/s; relative square %.3g, mean %.4f, blocks %.2f %%; %.2f s here, where bare "
            "Embree has %.2f of the speed for which the goal holds\n",
            static_cast<unsigned long long>(seed), made.building, made.preparing, made.seconds - made.preparing,
            made.cpu_seconds / places, stage.samples() / made.seconds * 1e-6, made.rays / made.seconds * 1e-6, error,
            found.mean_ratio.g, 100 * found.block_difference, seconds, speed);
        if (index == 0)
            for (const auto& line : made.said) std::printf("  %s\n", line.c_str());
        scaled.push_back(seconds * speed);
    }
    if (row.biased)
        std::printf("  %s: %llu of %llu seeds are good\n", row.name.c_str(), static_cast<unsigned long long>(good),
                    static_cast<unsigned long long>(seeds));
    print_figure("render." + row.name, scaled, {"s", "", 1, 2}, row.goal, false,
                 !row.biased || good + most_bad >= seeds);
}

/// Warm daemons: they have the scene, as a run before this one brought it.
void measure_networked(const NetworkedRow& row, const Registry& registry) {
    const int rounds = repeated(5);
    Constants constants = row.constants;
    if (smoke()) constants["samples"] = "1";
    constants["file"] = test::reference_file("cornell_grey.pbrt").value().string();
    Stage stage(registry, row.graph, constants);
    const LocalWorkers workers(LIGHTNET_STARTS_LIGHTNETD, 2, 1);
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
    figure("render." + row.name, more, 0.01, false);
}

void measure_all(const std::vector<std::string>& names) {
    const Registry registry{standard_nodes()};
    const auto wanted = [&](const std::string& name) {
        return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    };
    const Machine machine;
    for (const Row& row : rows())
        if (wanted(row.name)) measure(row, registry, machine);
    for (const NetworkedRow& row : networked_rows())
        if (wanted(row.name)) measure_networked(row, registry);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    return lightnet::bench::run("render", [&] { lightnet::bench::measure_all({argv + 1, argv + argc}); });
}
