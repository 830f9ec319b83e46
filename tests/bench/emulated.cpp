#include "tests/bench/emulated.hpp"

#include <atomic>
#include <stdexcept>

#include "core/run/assembly/fingerprint.hpp"
#include "core/run/master/master_renderer.hpp"
#include "tests/bench/figure.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::bench {
namespace {

using Clock = std::chrono::steady_clock;

List refs(const std::vector<std::string>& inputs) {
    List list;
    for (const auto& input : inputs) list.push_back(Value{NodeRef{input}});
    return list;
}

}  // namespace

Registry emulated_kinds(std::shared_ptr<Slowness> slowness, const std::string& slow_kind) {
    const auto of = [=](const std::string& kind) { return kind == slow_kind ? slowness : nullptr; };
    return Registry(emulated_kinds_with(of("EmulatedLight"), of("EmulatedImage")));
}

Node emulated_light(const std::string& name, double microseconds, const std::vector<std::string>& inputs) {
    return {name, "EmulatedLight", refs(inputs), {{"microseconds", Value{microseconds}}}, {}};
}

Node emulated_image(double milliseconds, double questions, const std::vector<std::string>& inputs) {
    return {"image",
            "EmulatedImage",
            refs(inputs),
            {{"milliseconds", Value{milliseconds}},
             {"questions", Value{questions}},
             {"film", Value{Table{{Value{1.0}, Value{1.0}}, {}}}}},
            {}};
}

double seconds_of_emulated(const Network& network, std::uint64_t run, Carrier& carrier, const Plan& plan,
                           std::size_t tiles, std::size_t in_flight, Counters* counters) {
    MasterRenderer::Job job;
    job.run = run;
    job.image = static_cast<std::uint32_t>(renderer_of(network.graph, network.registry));
    job.width = static_cast<std::uint32_t>(network.width_of(job.image));
    for (std::uint32_t i = 0; i < tiles; ++i) job.tiles.push_back({i, 0, 1, 1, 0, 1});
    job.credit = {in_flight, in_flight};
    std::size_t taken = 0;
    MasterRenderer master(std::move(job), carrier, [&](const Tile&, std::span<const Rgb>) { ++taken; });
    master.use(plan);
    const double seconds = seconds_of([&] {
        while (!master.work(std::chrono::milliseconds(100))) {
        }
    });
    if (taken != tiles) throw std::runtime_error("tiles are missing");
    if (counters) *counters = master.counters();
    return seconds;
}

double seconds_of_places(std::uint32_t places, double milliseconds, std::size_t tiles,
                         std::shared_ptr<Slowness> slowness) {
    constexpr std::uint64_t run_id = 1;
    const Registry kinds = emulated_kinds(slowness, "EmulatedImage");
    Job job;
    job.isa = usual_isa();
    job.graph.file = "emulated.lua";
    job.graph.nodes = {emulated_image(milliseconds, 0)};
    const auto network = build_network(job, kinds, LoadedScene{});
    const Plan all = plan(job.graph, kinds, {}, {{"", places}});
    ThreadedRun run(network, run_id, all, job.tuning);
    if (slowness->slowed >= 0) slowness->slowed_at += Clock::now().time_since_epoch();
    const double seconds = seconds_of_emulated(*network, run_id, run.carrier(), all, tiles * places, 2);
    run.stop();
    return seconds;
}

double seconds_of_hosts(const std::vector<std::string>& endpoints, const Picture& picture, std::size_t places,
                        double milliseconds, std::size_t tiles) {
    const Registry kinds = emulated_kinds(nullptr, "");
    Cluster::Options options;
    options.run = 1;
    options.job.scene = picture.job.scene;  // a host serves no run without one
    options.job.files = picture.job.files;
    options.job.isa = picture.job.isa;
    options.job.width = options.job.height = 1;
    options.job.graph.file = "emulated.lua";
    options.job.graph.nodes = {emulated_image(milliseconds, 0), {"scene", "Scene", {Value{picture.job.scene}}, {}, {}}};
    options.job.graph.nodes[0].params["scene"] = Value{NodeRef{"scene"}};
    options.files = picture.files;
    options.endpoints = endpoints;
    const Graph graph = options.job.graph;
    options.plan = [&](const std::vector<HostOffer>& offers) { return plan(graph, kinds, {}, offers); };
    const auto network = build_network(options.job, kinds, LoadedScene{});
    Cluster cluster(std::move(options));
    const std::atomic<bool> never{false};
    cluster.gather(std::chrono::seconds(20), never);
    cluster.adopt(cluster.plan());
    if (cluster.plan().places.size() != places) throw std::runtime_error("not all hosts are there");
    const double seconds = seconds_of_emulated(*network, 1, cluster, cluster.plan(), tiles * places, 2);
    cluster.finish();
    return seconds;
}

}  // namespace lightnet::bench
