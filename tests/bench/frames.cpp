// What a sequence costs beside its samples: 24 frames with a moving camera on two daemons, and one still of the same
// scene with as many samples as all of them together, which is loaded once. In turns.
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/figure.hpp"
#include "tests/support/folder.hpp"
#include "transport/start/child.hpp"

namespace {

using namespace std::chrono_literals;
namespace bench = lightnet::bench;

const int rounds = 1, frames = bench::sized(24, 2), samples = bench::sized(32, 1);
constexpr double goal = 1.05;  // times

void run(std::vector<std::string> more) {
    std::vector<std::string> words{LIGHTNET_STARTS_LIGHTNET,
                                   "run",
                                   "--local-workers",
                                   "2",
                                   "--size",
                                   bench::sized("320x240", "16x16"),
                                   "--cache",
                                   "none",
                                   "--progress",
                                   "none",
                                   "--forget"};
    words.insert(words.end(), more.begin(), more.end());
    const auto ended = lightnet::run_program(std::move(words), "", 1h);
    if (ended.code != 0) throw std::runtime_error(ended.text);
}

void measure(const std::string& scene, double fov) {
    const lightnet::test::Folder folder;
    const auto graph = folder.write(
        "film.lua", "scene = Scene { '" LIGHTNET_SOURCE_DIR "/graphs/" + scene +
                        "', camera = { fov = " + std::to_string(fov) +
                        " + frame / 1000 } }\n"
                        "direct = DirectLighting {} bounce = PathTracing {} light = Combine { direct, bounce }\n"
                        "image = RayTracer { light, scene = scene, samples = 1, film = { 8, 8 } }\n");
    std::vector<double> ratios;
    for (int round = 0; round < rounds; ++round) {
        const double film = bench::seconds_of([&] {
            run({graph, "--frames", "1-" + std::to_string(frames), "--samples", std::to_string(samples), "-o",
                 folder.file("shot.####.exr")});
        });
        const double still = bench::seconds_of([&] {
            run({graph, "--samples", std::to_string(frames * samples), "-o", folder.file("still.exr")});
        });
        std::printf("  %s: %d frames %.2f s, a still of all samples %.2f s\n", scene.c_str(), frames, film, still);
        ratios.push_back(film / still);
    }
    bench::print_figure("frames " + scene, ratios, {"", "times ", 1, 3}, goal, false);
}

}  // namespace

int main() {
    return bench::run("frames", [] {
        measure("cornell_box.pbrt", 39);
        measure("glass_ball.pbrt", 39);
        measure("studio.pbrt", 40);
    });
}
