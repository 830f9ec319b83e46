#include "tests/bench/picture.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/base/hash.hpp"
#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/serial/serial.hpp"
#include "lua/load_graph.hpp"
#include "tests/bench/figure.hpp"

namespace lightnet::bench {
namespace {

constexpr std::uint32_t tile_size = 32;  // as the launcher cuts them

}  // namespace

Picture::Picture(const Registry& registry, std::uint32_t size, std::uint32_t samples) {
    const LuaOptions constants{{{"size", std::to_string(size)}, {"samples", std::to_string(samples)}}};
    job.graph = check(load_graph(LIGHTNET_SOURCE_DIR "/graphs/cornell.lua", constants), registry);
    job.scene = scene_file(job.graph, registry);
    job.isa = usual_isa();
    job.width = job.height = size;
    DiskFiles disk;
    auto scene = read_scene(disk, job.scene);
    files = disk.seen();
    for (const auto& [path, bytes] : files) job.files.push_back({path, content_hash(*bytes), bytes->size()});
    network = build_network(job, registry, LoadedScene{std::move(scene)});
    image = renderer_of(job.graph, registry);
    tiles = tiles_of(size, size, tile_size, samples);
}

Job Picture::of_nodes(const std::string& file, std::vector<Node> nodes) const {
    Job other;
    other.scene = job.scene;
    other.files = job.files;
    other.isa = job.isa;
    other.width = other.height = 1;
    other.graph.file = file;
    other.graph.nodes = std::move(nodes);
    other.graph.nodes.push_back({"scene", "Scene", {Value{job.scene}}, {}, {}});
    return other;
}

Pixels render_serially(const Picture& picture, std::size_t first, std::size_t step) {
    SerialRun run(*picture.network);
    Pixels pixels;
    for (std::size_t i = first; i < picture.tiles.size(); i += step) pixels.push_back(run.render(picture.tiles[i]));
    return pixels;
}

double seconds_of_independent_halves(const Picture& picture, const std::function<void()>& meanwhile) {
    std::array<double, 2> seconds{};
    std::atomic<int> working{2};
    std::vector<std::jthread> threads;
    for (std::size_t half = 0; half < 2; ++half)
        threads.emplace_back([&, half] {
            seconds[half] = seconds_of([&] { render_serially(picture, half, 2); });
            --working;
        });
    while (working > 0) meanwhile();
    threads.clear();
    return (seconds[0] + seconds[1]) / 2;
}

double seconds_of_master(const Picture& picture, std::uint64_t run, Carrier& carrier, const Plan& plan) {
    return seconds_of([&] {
        std::size_t taken = 0;
        MasterRenderer::Job job{run,
                                static_cast<std::uint32_t>(picture.image),
                                static_cast<std::uint32_t>(picture.width()),
                                picture.tiles,
                                {2, 2}};
        MasterRenderer master(std::move(job), carrier, [&](const Tile&, std::span<const Rgb>) { ++taken; });
        master.use(plan);
        while (!master.work(std::chrono::milliseconds(50))) {
        }
        if (taken != picture.tiles.size()) throw std::runtime_error("tiles are missing");
    });
}

}  // namespace lightnet::bench
