// What `lightnet render --lighting auto` is worth: processor time x relative square error of its picture, trials and
// all from launch to the written file, beside those of each lighting that it may choose, by their names, in turns and
// with the same seeds. The figure is the least product of all over its own.
// Errors are relative squares (compare.hpp) without the worst thousandth of the pixels, as one firefly in one seed
// would decide; with them they are printed, too. The reference's own noise is taken off. Arguments: names of scenes;
// without any, all that have a reference. LIGHTNET_BENCH_SAMPLES: per pixel, instead of 64; LIGHTNET_BENCH_SEEDS:
// instead of three. The lines of each scene are rows of a table, in Markdown, with plain path tracing in layers for
// comparison.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/scene_files.hpp"
#include "tests/support/folder.hpp"
#include "tools/cli/lightings.hpp"
#include "transport/start/child.hpp"

namespace lightnet::bench {
namespace {

constexpr double goal = 0.9;
const int seeds = [] {
    const char* given = std::getenv("LIGHTNET_BENCH_SEEDS");
    return repeated(given ? std::max(1, std::atoi(given)) : 3);
}();
const std::string by_trials(lighting_by_trials);

std::string samples() {
    const char* given = std::getenv("LIGHTNET_BENCH_SAMPLES");
    return smoke() ? "1" : given ? given : "64";
}

// Of all programs that have ended.
double seconds_of_children() {
    rusage used{};
    ::getrusage(RUSAGE_CHILDREN, &used);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// What pictures of one lighting took, and how far they are off, by seed.
struct Pictures {
    std::vector<double> seconds, errors, with_fireflies;
    // Errors differ more from seed to seed than times, and what is chosen may.
    double cost() const { return mean(seconds) * mean(errors); }
    static double mean(const std::vector<double>& values) {
        double sum = 0;
        for (const double value : values) sum += value / double(values.size());
        return sum;
    }
};

void add(const ReferenceScene& scene, const SceneFiles& files, const Picture& reference, const std::string& lighting,
         int seed, Pictures& pictures) {
    const test::Folder folder;
    const auto side = [](std::uint32_t pixels) { return std::to_string(sized(pixels, pixels / 8)); };
    const std::string out = folder / "x.exr";
    const double before = seconds_of_children();
    const auto ended =
        run_program({LIGHTNET_STARTS_LIGHTNET, "render", files.main().string(), "--lighting", lighting, "--samples",
                     samples(), "--size", side(reference.width) + "x" + side(reference.height), "--seed",
                     std::to_string(seed), "--forget", "--cache", "none", "--progress", "plain", "-o", out},
                    "", std::chrono::minutes(60));
    if (ended.code != 0) throw std::runtime_error("lightnet ended badly: " + ended.text);
    pictures.seconds.push_back(seconds_of_children() - before);
    if (lighting == by_trials)
        if (const auto words = ended.text.find("lighting by "); words != ended.text.npos)
            std::printf("  %s, seed %d: %s\n", scene.name.c_str(), seed,
                        ended.text.substr(words, ended.text.find(';', words) - words).c_str());
    if (smoke()) return;
    const Difference found = compare(reference, read_exr(out));
    pictures.errors.push_back(std::max(1e-7, found.relative_square_trimmed - scene.noise));
    pictures.with_fireflies.push_back(std::max(1e-7, found.relative_square - scene.noise));
}

void measure(const ReferenceScene& scene) {
    const SceneFiles files(scene);
    if (files.missing()) return not_run("lighting." + scene.name, *files.missing());
    const Picture reference = read_exr(files.reference());
    std::vector<std::string> names{by_trials, lightings().front().name};
    for (const auto& lighting : lightings())
        if (lighting.on_trial) names.push_back(lighting.name);
    std::map<std::string, Pictures> all;
    for (int seed = 1; seed <= seeds; ++seed)
        for (const auto& name : names) add(scene, files, reference, name, seed, all[name]);
    if (smoke()) return figure("lighting." + scene.name, {1}, goal, true);
    double best = 1e300;
    for (const auto& name : names) {
        const Pictures& pictures = all[name];
        std::printf("| %s | %s | %.2f s | %.3e | %.3e | with fireflies %.3e |\n", scene.name.c_str(), name.c_str(),
                    Pictures::mean(pictures.seconds), Pictures::mean(pictures.errors), pictures.cost(),
                    Pictures::mean(pictures.with_fireflies));
        const Lighting* lighting = find_lighting(name);
        if (lighting && lighting->on_trial) best = std::min(best, pictures.cost());
    }
    figure("lighting." + scene.name, {best / all[by_trials].cost()}, goal, true);
}

void measure_all(const std::vector<std::string>& names) {
    for (const ReferenceScene& scene : reference_scenes())
        if (names.empty() || std::find(names.begin(), names.end(), scene.name) != names.end()) measure(scene);
}

}  // namespace
}  // namespace lightnet::bench

int main(int count, char** words) {
    return lightnet::bench::run("lighting", [&] { lightnet::bench::measure_all({words + 1, words + count}); });
}
