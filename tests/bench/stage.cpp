#include "tests/bench/stage.hpp"

#include <chrono>
#include <utility>

#include "core/base/hash.hpp"
#include "core/network/graph/check.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/master/coordinator.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/master/tiles_by_pass.hpp"
#include "lua/load_graph.hpp"
#include "tests/bench/figure.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t tile_size = 32;  // as the launcher cuts them

}  // namespace

Stage::Stage(const Registry& registry, const std::string& graph, const std::map<std::string, std::string>& constants)
    : Stage(registry, load_graph(LIGHTNET_SOURCE_DIR "/graphs/" + graph, LuaOptions{constants})) {}

Stage::Stage(const Registry& registry, const Graph& graph) : registry_(registry) {
    job_.graph = check(graph, registry);
    job_.scene = scene_file(job_.graph, registry);
    job_.isa = usual_isa();
    const GraphFilm film = film_of(job_.graph, registry);
    job_.width = film.width;
    job_.height = film.height;
    DiskFiles disk;
    scale_ = read_scene(disk, job_.scene).film.scale;
    files_ = disk.seen();
    for (const auto& [path, bytes] : files_) job_.files.push_back({path, content_hash(*bytes), bytes->size()});
    image_ = renderer_of(job_.graph, registry);
    const double samples = std::get<double>(job_.graph.nodes[image_].params.at("samples").data);
    format_ = {job_.width, job_.height, layers_of(job_.graph, registry).film, static_cast<std::uint32_t>(samples)};
}

void Stage::lead(Carrier& carrier, const Plan& plan, std::uint64_t run, const std::function<void()>& check,
                 Rendered& made) {
    Film film(format_);
    Coordinator::Options options;
    options.run = run;
    options.graph = &job_.graph;
    options.registry = &registry_;
    options.width = static_cast<std::uint32_t>(format_.layers.size());
    options.made_from = made_from(job_);
    options.cache = cache_;
    options.say = [&](const std::string& text) { made.said.push_back(text); };
    Coordinator coordinator(std::move(options), carrier);
    coordinator.propose(plan);
    TilesByPass passes(job_.graph, registry_, tiles_of(job_.width, job_.height, tile_size, format_.samples));
    while (!passes.empty()) {
        auto tiles = passes.begin_next();
        coordinator.begin_pass(passes.pass());
        made.preparing += seconds_of([&] {
            while (!coordinator.prepare(50ms)) check();
        });
        MasterRenderer::Job job{run,
                                static_cast<std::uint32_t>(image_),
                                static_cast<std::uint32_t>(format_.layers.size()),
                                std::move(tiles),
                                {2, 2 * MasterRenderer::most_together}};
        job.verify = job_.tuning.verify;
        MasterRenderer master(std::move(job), coordinator,
                              [&](const Tile& tile, std::span<const Rgb> pixels) { film.add(tile, pixels); });
        master.use(coordinator.in_force());
        while (!master.work(50ms)) check();
    }
    made.picture = film.picture(scale_);
}

Rendered Stage::in_threads(std::uint32_t places) {
    // Anew each time: values that places share would be there already.
    std::shared_ptr<const Network> network;
    const Plan whole = plan(job_.graph, registry_, {}, {{"", places}});
    Rendered made;
    const double cpu = process_seconds();
    made.building = seconds_of([&] {
        DiskFiles disk;
        network = build_network(job_, registry_, disk);
    });
    made.seconds = seconds_of([&] {
        ThreadedRun run(network, 1, whole, job_.tuning);
        lead(
            run.carrier(), whole, 1, [&] { run.check(); }, made);
        made.rays = static_cast<double>(run.stop().rays);
    });
    made.cpu_seconds = process_seconds() - cpu;
    return made;
}

Rendered Stage::on(Cluster& cluster, std::uint64_t run) {
    Rendered made;
    const double cpu = process_seconds();
    made.seconds = seconds_of([&] {
        lead(
            cluster, cluster.plan(), run, [] {}, made);
    });
    made.cpu_seconds = process_seconds() - cpu;
    return made;
}

Cluster::Options Stage::options(std::vector<std::string> endpoints, std::uint64_t run) const {
    Cluster::Options options;
    options.run = run;
    options.job = job_;
    options.files = files_;
    options.endpoints = std::move(endpoints);
    options.plan = [this](const std::vector<HostOffer>& offers) { return plan(job_.graph, registry_, {}, offers); };
    return options;
}

}  // namespace lightnet::bench
