// What preparing costs: photons and a cache's rehearsal on two places beside one that has the machine to itself; a
// whole run of photon maps, from the command to the picture, on two daemons beside one; and the way of ten million
// photons to a host beside the same bytes through plain ZeroMQ, over a line of a gigabit per second and over loopback
// alone. Arguments: photons, rehearsal, command, distribution; without any, all of them.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <zmq.hpp>

#include "core/estimate/photon.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/services.hpp"
#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/stage.hpp"
#include "tests/support/bad_line.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/host_thread.hpp"
#include "transport/start/child.hpp"
#include "transport/start/local_workers.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

const int rounds = repeated(3);
const std::size_t photons = sized<std::size_t>(10'000'000, 200'000);

/// Has so many photons, made with as little work as there can be, and gives no light.
class Bulk final : public LightOp {
public:
    explicit Bulk(const NodeContext& here) : turn_(static_cast<std::uint64_t>(here.integer("turn"))) {}

    void prepare(Services& services) override {
        constexpr std::size_t each = 100'000;
        const auto all = services.map<Photon>(photons / each, [&](std::size_t shard, std::vector<Photon>& out) {
            out.resize(each);
            for (std::size_t i = 0; i < each; ++i) {
                const auto bits = mix(turn_ * photons + shard * each + i);
                std::memcpy(&out[i].incoming, &bits, sizeof bits);
            }
        });
        services.say(std::to_string(all.size()) + " photons");
    }
    void light(std::span<const Query>, std::span<Rgb>) const override {}

private:
    std::uint64_t turn_;
};

Registry with_bulk() {
    auto kinds = standard_nodes();
    Kind kind{.name = "Bulk", .help = "prepares much", .run = {.prepares = true}};
    kind.params = {{.name = "turn", .type = ParamType::integer, .help = "makes other bytes", .initial = Value{0.0}}};
    kind.make_light = [](const NodeContext& here) { return std::make_unique<Bulk>(here); };
    kinds.push_back(std::move(kind));
    return Registry(std::move(kinds));
}

Graph graph_of(const std::string& lighting, std::uint32_t side) {
    const std::string size = std::to_string(side);
    return parse_graph("scene = Scene { \"glass_ball.pbrt\" }\n" + lighting +
                           "image = RayTracer { lighting, scene = scene, samples = 1, film = { " + size + ", " + size +
                           " } }\n",
                       LIGHTNET_SOURCE_DIR "/graphs/prepare.lua");
}

void measure_efficiency(const char* name, const Registry& registry, const Graph& graph) {
    Stage stage(registry, graph);
    std::vector<double> efficiency;
    for (int round = 0; round < rounds; ++round) {
        const double one = stage.in_threads(1).preparing, two = stage.in_threads(2).preparing;
        std::printf("  %s: %.2f s at one place, %.2f s at two\n", name, one, two);
        efficiency.push_back(one / (2 * two));
    }
    figure(name, efficiency, 0.95, true);
}

/// Seconds from the command to its picture, on daemons of one place each. What is prepared is found in no cache.
double seconds_of_command(const test::Folder& folder, const std::vector<std::string>& daemons, int seed) {
    std::string hosts;
    for (const auto& daemon : daemons) hosts += "place '" + daemon + "' {}\n";
    const auto graph =
        folder.write("maps.lua", "scene = Scene { '" LIGHTNET_SOURCE_DIR
                                 "/graphs/glass_ball.pbrt' }\n"
                                 "direct = DirectLighting {}\n"
                                 "caustics = PhotonMap { paths = 'caustic', photons = " +
                                     sized<std::string>("1e6", "1e3") +
                                     " }\n"
                                     "diffuse = PhotonMap { paths = 'diffuse', photons = " +
                                     sized<std::string>("4e6", "4e3") +
                                     " }\n"
                                     "lighting = Combine { direct, caustics, diffuse }\n"
                                     "image = RayTracer { lighting, scene = scene, samples = 4, film = { 128, "
                                     "128, file = 'maps.exr' } }\n");
    const std::vector<std::string> words{LIGHTNET_STARTS_LIGHTNET,
                                         "run",
                                         graph,
                                         "--hosts",
                                         folder.write("hosts.lua", hosts),
                                         "--seed",
                                         std::to_string(seed),
                                         "--cache",
                                         "none",
                                         "--forget",
                                         "--progress",
                                         "none",
                                         "-o",
                                         folder / "maps.exr"};
    ProgramOutput output;
    const double seconds = seconds_of([&] { output = run_program(words, "", 5min); });
    if (output.code != 0)
        throw std::runtime_error("the command ended with " + std::to_string(output.code) + ": " + output.text);
    return seconds;
}

void measure_command() {
    const test::Folder folder;
    const LocalWorkers workers(LIGHTNET_STARTS_LIGHTNETD, 2, 1);
    const auto both = workers.endpoints();
    std::vector<double> efficiency;
    int seed = 0;
    seconds_of_command(folder, both, ++seed);  // files of the scene are brought
    for (int round = 0; round < rounds; ++round) {
        const double one = seconds_of_command(folder, {both[0]}, ++seed),
                     two = seconds_of_command(folder, both, ++seed);
        std::printf("  prepare.command: %.2f s on one daemon, %.2f s on two\n", one, two);
        efficiency.push_back(one / (2 * two));
    }
    figure("prepare.command", efficiency, 0.95, true);
}

/// Results in memory.
class Kept final : public ResultCache {
public:
    Result find(const Hash& recipe) const override {
        const auto found = kept_.find(recipe);
        return found == kept_.end() ? Result{} : found->second;
    }
    void keep(const Hash& recipe, const Result& result) override { kept_[recipe] = result; }

private:
    std::map<Hash, Result> kept_;
};

constexpr double unlimited = 0, gigabit = 125e6;  // bytes per second

/// Seconds that so many bytes take from one thread to another over tcp, in messages of a megabyte.
double seconds_of_wire(std::size_t bytes, double limit) {
    constexpr std::size_t piece = 1 << 20;
    zmq::context_t context(2);
    zmq::socket_t in(context, zmq::socket_type::pair), out(context, zmq::socket_type::pair);
    in.set(zmq::sockopt::rcvhwm, 16);
    out.set(zmq::sockopt::sndhwm, 16);
    in.bind("tcp://127.0.0.1:*");
    test::BadLine line(in.get(zmq::sockopt::last_endpoint));
    line.limit(limit);
    out.connect(limit > 0 ? line.endpoint() : in.get(zmq::sockopt::last_endpoint));
    const std::vector<std::byte> data(piece, std::byte{1});
    const std::size_t count = (bytes + piece - 1) / piece;
    std::jthread sender([&] {
        for (std::size_t i = 0; i < count; ++i) out.send(zmq::buffer(data), zmq::send_flags::none);
    });
    return seconds_of([&] {
        std::vector<std::byte> whole(count * piece);
        for (std::size_t i = 0; i < count; ++i) {
            zmq::message_t message;
            static_cast<void>(in.recv(message));
            std::memcpy(whole.data() + i * piece, message.data(), message.size());
        }
    });
}

void measure_distribution(const char* name, const Registry& registry, double limit) {
    std::vector<double> ratios;
    for (int round = 0; round < rounds; ++round) {
        const test::Folder folder;
        Kept kept;
        const auto graph = graph_of("lighting = Bulk { turn = " + std::to_string(round) + " }\n", 16);
        Stage stage(registry, graph);
        stage.use(kept);
        stage.in_threads(2);  // the results are there now
        const test::HostThread host(registry, 1, folder / "cache");
        test::BadLine line(host.endpoint());
        line.limit(limit);
        Cluster cluster(stage.options({limit > 0 ? line.endpoint() : host.endpoint()}, std::uint64_t(round) + 1));
        const std::atomic<bool> never{false};
        cluster.gather(5s, never);
        cluster.adopt(cluster.plan());
        const double ours = stage.on(cluster, std::uint64_t(round) + 1).preparing;
        cluster.finish();
        const double wire = seconds_of_wire(photons * sizeof(Photon), limit);
        std::printf("  %s: %.0f MB to a host in %.2f s, through plain ZeroMQ in %.2f s\n", name,
                    double(photons * sizeof(Photon)) * 1e-6, ours, wire);
        ratios.push_back(ours / wire);
    }
    figure(name, ratios, 1.2, false);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    namespace bench = lightnet::bench;
    const std::string only = argc > 1 ? argv[1] : "";
    return bench::run("prepare", [&] {
        const lightnet::Registry registry = bench::with_bulk();
        if (only.empty() || only == "photons")
            bench::measure_efficiency("prepare.photons", registry,
                                      bench::graph_of("lighting = PhotonMap { paths = \"indirect\", photons = " +
                                                          bench::sized<std::string>("4e6", "4e3") + " }\n",
                                                      16));
        if (only.empty() || only == "rehearsal")
            bench::measure_efficiency("prepare.rehearsal", registry,
                                      bench::graph_of("paths = PathTracing { paths = \"all\" }\n"
                                                      "lighting = IrradianceCache { paths, rays = 2048 }\n",
                                                      bench::sized(256u, 32u)));
        if (only.empty() || only == "command") bench::measure_command();
        if (only.empty() || only == "distribution") {
            bench::measure_distribution("prepare.distribution", registry, bench::gigabit);
            bench::measure_distribution("prepare.distribution.loopback", registry, bench::unlimited);
        }
    });
}
