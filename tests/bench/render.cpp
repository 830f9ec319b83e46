// How long pictures take until they are good: rendered with two places in threads, beside reference pictures. The
// references are not part of the project: LIGHTNET_SHARED names the folder that has them under reference/.
// Arguments: names of rows; without any, all of them. LIGHTNET_BENCH_SAMPLES changes the samples per pixel.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "core/film/film.hpp"
#include "core/graph/check.hpp"
#include "core/graph/graph_film.hpp"
#include "core/readers/read_scene.hpp"
#include "core/runtime/fingerprint.hpp"
#include "core/runtime/job.hpp"
#include "core/runtime/master_renderer.hpp"
#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "transport/threaded_run.hpp"

namespace lightnet::bench {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::uint32_t side = 256, tile_size = 32, places = 2;
constexpr double target = 1e-3;  // mean of d² / (reference² + 0.01)

/// A line of the table: what is rendered, what it is compared with, and within how many seconds it should be good.
struct Row {
    std::string name, graph, scene, reference;
    int samples;   // per pixel; path_all.lua follows four paths for each
    double noise;  // of the reference itself, in the same measure; subtracted
    double goal;   // seconds
};

const std::vector<Row>& rows() {
    static const std::vector<Row> table{
        {"cornell_grey", "path_all.lua", "cornell_grey.pbrt", "cornell_grey.mits_path_2048.exr", 16, 0, 3.5},
        {"indirect", "path_all.lua", "indirect.pbrt", "indirect.mits_path_2048.exr", 16, 6e-4, 40},
        {"terrain", "path_all.lua", "terrain.pbrt", "terrain.combined.exr", 16, 0, 5},
        {"cornell_grey_layers", "path.lua", "cornell_grey.pbrt", "cornell_grey.mits_path_2048.exr", 64, 0, 3.5},
    };
    return table;
}

double process_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// One rendering: its picture, and what it took.
struct Rendered {
    Picture picture;
    double seconds = 0, cpu_seconds = 0;
    double rays = 0;
};

class Stage {
public:
    Stage(const Row& row, const fs::path& folder, const Registry& registry) {
        const LuaOptions constants{{{"file", (folder / row.scene).string()},
                                    {"width", std::to_string(side)},
                                    {"height", std::to_string(side)},
                                    {"samples", std::to_string(row.samples)}}};
        job_.graph = check(load_graph(LIGHTNET_SOURCE_DIR "/graphs/" + row.graph, constants), registry);
        job_.scene = scene_file(job_.graph, registry);
        job_.isa = usual_isa();
        job_.width = job_.height = side;
        DiskFiles disk;
        SceneData scene = read_scene(disk, job_.scene);
        scale_ = scene.film.scale;
        building_ = seconds_of([&] { network_ = build_network(job_, registry, std::move(scene)); });
        format_ = {side, side, network_->layers.film, static_cast<std::uint32_t>(row.samples)};
        plan_ = plan(job_.graph, registry, {}, {{"", places}});
        image_ = renderer_of(job_.graph, registry);
    }

    double building() const { return building_; }

    Rendered render() const {
        Film film(format_);
        Rendered made;
        const double cpu = process_seconds();
        made.seconds = seconds_of([&] {
            ThreadedRun run(network_, 1, plan_, job_.rules);
            MasterRenderer master({1,
                                   static_cast<std::uint32_t>(image_),
                                   static_cast<std::uint32_t>(format_.layers.size()),
                                   tiles_of(side, side, tile_size, format_.samples),
                                   {2, 2}},
                                  run.carrier(),
                                  [&](const Tile& tile, std::span<const Rgb> pixels) { film.add(tile, pixels); });
            master.use(plan_);
            while (!master.work(50ms)) run.check();
            made.rays = static_cast<double>(run.stop().rays);
        });
        made.cpu_seconds = process_seconds() - cpu;
        made.picture = film.picture(scale_);
        return made;
    }

private:
    Job job_;
    std::shared_ptr<const Network> network_;
    FilmFormat format_;
    Plan plan_;
    std::size_t image_ = 0;
    float scale_ = 1;
    double building_ = 0;
};

void measure(const Row& row, const fs::path& folder, const Registry& registry) {
    const Stage stage(row, folder, registry);
    const Rendered made = stage.render();
    const Difference found = compare(read_exr(folder / row.reference), made.picture);
    const double error = std::max(0.0, found.relative_square - row.noise);
    const double samples = double{side} * side * row.samples;
    std::printf(
        "  %s: %d samples per pixel in %.2f s (%.2f s of work per place; %.2f s to build the scene), "
        "%.2f M samples/s, %.2f M rays/s, %.2f rays per sample, relative square %.3g, mean %.4f\n",
        row.name.c_str(), row.samples, made.seconds, made.cpu_seconds / places, stage.building(),
        samples / made.seconds * 1e-6, made.rays / made.seconds * 1e-6, made.rays / samples, found.relative_square,
        found.mean_ratio.g);
    // Noise falls as samples grow: what it would take until it is at the target.
    const double seconds = made.seconds * error / target;
    std::printf("  %s: %.2f s of work per place to %g\n", row.name.c_str(), made.cpu_seconds / places * error / target,
                target);
    std::printf("render.%s %.2fs <=%gs %s\n", row.name.c_str(), seconds, row.goal,
                seconds <= row.goal ? "ok" : "short");
    std::fflush(stdout);
}

int measure_all(const std::vector<std::string>& wanted) {
    const char* shared = std::getenv("LIGHTNET_SHARED");
    const fs::path folder = fs::path(shared ? shared : "") / "reference";
    if (!shared || !fs::exists(folder)) {
        std::printf("  the reference pictures are not here: LIGHTNET_SHARED names the folder above reference/\n");
        return 0;
    }
    const Registry registry{standard_nodes()};
    for (Row row : rows()) {
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), row.name) == wanted.end()) continue;
        if (const char* samples = std::getenv("LIGHTNET_BENCH_SAMPLES")) row.samples = std::atoi(samples);
        measure(row, folder, registry);
    }
    return 0;
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    try {
        return lightnet::bench::measure_all({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "render: %s\n", error.what());
        return 1;
    }
}
