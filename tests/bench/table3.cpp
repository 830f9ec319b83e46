// The paper's Table 3: functional and data parallelism at once. The network of its figure 5 on three hosts with 4, 2
// and 1 processors, laid out as graphs/paper/hosts/table3.lua says: operators that cost differently, on hosts that have
// differently many of them. Nothing is dealt out evenly; who answers what follows from where the questions go.
//
// Both figures are the work of all operators, over the time that it took and all processors.
#include "tests/bench/table3.hpp"

#include <atomic>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/emulated.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/picture.hpp"
#include "tests/support/host_thread.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet::bench {

Hosts table3_hosts(const std::vector<std::string>& endpoints) {
    const std::string file = LIGHTNET_SOURCE_DIR "/graphs/paper/hosts/table3.lua";
    Hosts hosts = load_hosts(file);
    if (hosts.hosts.size() != endpoints.size()) throw std::runtime_error(file + " names other hosts");
    for (std::size_t i = 0; i < endpoints.size(); ++i) hosts.hosts[i].endpoint = endpoints[i];
    return hosts;
}

namespace {

using namespace std::chrono_literals;

const std::size_t tiles = sized<std::size_t>(600, 20);
constexpr double questions = 256;  // per tile
constexpr std::uint64_t run_id = 1;

// Microseconds per question. The lighting asks each of its inputs, and so does `first`, whom the cache asks.
constexpr double image = 10, direct = 10, caustics = 30, global = 30, soft = 20;
const double work = double(tiles) * questions * 1e-6 * (image + 2 * direct + 2 * caustics + global + soft);

Job job_of(const Picture& picture) {
    Job job;
    job.scene = picture.job.scene;  // a host serves no run without one
    job.files = picture.job.files;
    job.isa = picture.job.isa;
    job.width = job.height = 1;
    job.graph.file = "table3.lua";
    job.graph.nodes = {emulated_light("direct", direct),
                       emulated_light("caustics", caustics),
                       emulated_light("global", global),
                       emulated_light("first", 0, {"direct", "caustics", "global"}),
                       emulated_light("soft", soft, {"first"}),
                       emulated_light("lighting", 0, {"direct", "caustics", "soft"}),
                       emulated_image(image * 1e-3 * questions, questions, {"lighting"}),
                       {"scene", "Scene", {Value{job.scene}}, {}, {}}};
    job.graph.nodes[6].params["scene"] = Value{NodeRef{"scene"}};
    return job;
}

}  // namespace

void measure_emulated_hosts() {
    const Registry standard{standard_nodes()}, kinds = emulated_kinds(nullptr, "");
    const Picture picture(standard, 64, 16);
    const test::HostThread one(kinds, table3_places[0]), two(kinds, table3_places[1]), three(kinds, table3_places[2]);
    Cluster::Options options;
    options.run = run_id;
    options.job = job_of(picture);
    options.files = picture.files;
    options.endpoints = {one.endpoint(), two.endpoint(), three.endpoint()};
    const Hosts hosts = table3_hosts(options.endpoints);
    const Graph graph = options.job.graph;
    options.plan = [&](const std::vector<HostOffer>& offers) { return plan(graph, kinds, hosts, offers); };
    const auto network = build_network(options.job, kinds, LoadedScene{});
    Cluster cluster(std::move(options));
    const std::atomic<bool> never{false};
    cluster.gather(10s, never);
    cluster.adopt(cluster.plan());
    std::vector<double> efficiency;
    for (int round = 0; round < repeated(3); ++round) {
        const double seconds = seconds_of_emulated(*network, run_id, cluster, cluster.plan(), tiles, 16);
        efficiency.push_back(work / (7 * seconds));
    }
    figure("table3.emulated", efficiency, 0.9, true);
    cluster.finish();
}

}  // namespace lightnet::bench

int main(int argc, char** argv) {
    const std::string only = argc > 1 ? argv[1] : "";
    return lightnet::bench::run("table3", [&] {
        if (only.empty() || only == "emulated") lightnet::bench::measure_emulated_hosts();
        if (only.empty() || only == "real") lightnet::bench::measure_real_hosts();
    });
}
