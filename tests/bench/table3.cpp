// The paper's Table 3: functional and data parallelism at once, in the network of its figure 5. Seven places on three
// hosts, over tcp; costs are emulated by waiting, and dealt out so that every place has as much to do.
//
//   image ─▶ direct ×1, caustics ×3, bounce ×2 ─▶ direct
//
// Figure: the work of all nodes, divided by the places, over the time that it took.
#include <atomic>
#include <cstdio>

#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/emulated.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/picture.hpp"
#include "tests/support/host_thread.hpp"
#include "transport/cluster.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

constexpr double questions = 256, milliseconds = 12;  // per tile; of each place, for each tile
constexpr std::size_t tiles = 250;
constexpr std::uint64_t run_id = 1;

// What `places` places need for so many questions to one of them.
double microseconds(double places, double asked) { return 1e3 * milliseconds * places / asked; }

Job job_of(const Picture& picture) {
    Job job;
    job.scene = picture.job.scene;  // a host serves no run without one
    job.files = picture.job.files;
    job.isa = picture.job.isa;
    job.graph.file = "table3.lua";
    job.graph.nodes = {emulated_light("direct", microseconds(1, 2 * questions)),
                       emulated_light("caustics", microseconds(3, questions)),
                       emulated_light("bounce", microseconds(2, questions), {"direct"}),
                       emulated_image(milliseconds, questions, {"direct", "caustics", "bounce"}),
                       {"scene", "Scene", {Value{job.scene}}, {}, {}}};
    job.graph.nodes[3].params["scene"] = Value{NodeRef{"scene"}};
    job.tuning.bundle = 128;
    return job;
}

void measure() {
    const Registry standard{standard_nodes()};
    const Picture picture(standard, 64, 16);
    const Registry kinds = emulated_kinds(std::make_shared<Slowness>(), "");
    const test::HostThread one(kinds, 0), two(kinds, 0), three(kinds, 0);
    const Hosts hosts =
        parse_hosts("place '" + one.endpoint() + "' { image = 1, direct = 1, caustics = 1, places = 3 }\n" + "place '" +
                        two.endpoint() + "' { caustics = 1, bounce = 1, places = 2 }\n" + "place '" + three.endpoint() +
                        "' { caustics = 1, bounce = 1, places = 2 }\n",
                    "table3.lua");
    Cluster::Options options;
    options.run = run_id;
    options.job = job_of(picture);
    options.files = picture.files;
    options.endpoints = {one.endpoint(), two.endpoint(), three.endpoint()};
    const Graph graph = options.job.graph;
    options.plan = [&](const std::vector<HostOffer>& offers) { return plan(graph, kinds, hosts, offers); };
    const auto network = build_network(options.job, kinds, LoadedScene{});
    Cluster cluster(std::move(options));
    const std::atomic<bool> never{false};
    cluster.gather(10s, never);
    cluster.adopt(cluster.plan());
    std::vector<double> efficiency;
    for (int round = 0; round < 3; ++round)
        efficiency.push_back(tiles * milliseconds * 1e-3 /
                             seconds_of_emulated(*network, run_id, cluster, cluster.plan(), tiles, 16));
    show("efficiency of seven places", efficiency);
    figure("table3.emulated", median(efficiency), 0.9, true);
    cluster.finish();
}

}  // namespace
}  // namespace lightnet::bench

int main() {
    return lightnet::bench::run("table3", [&] { lightnet::bench::measure(); });
}
