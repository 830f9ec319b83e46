#include "tests/bench/paper.hpp"

#include <atomic>
#include <chrono>
#include <deque>
#include <stdexcept>

#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/emulated.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/picture.hpp"
#include "tests/support/host_thread.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet::bench {
namespace {

const std::string folder = LIGHTNET_SOURCE_DIR "/graphs/paper/";

std::vector<std::string> inputs_of(const Node& node) {
    std::vector<std::string> inputs;
    for (const auto& entry : node.entries)
        if (const auto* input = std::get_if<NodeRef>(&entry.data)) inputs.push_back(input->name);
    return inputs;
}

double cost_of(const EmulatedCosts& costs, const std::string& node) {
    const auto found = costs.microseconds.find(node);
    return found == costs.microseconds.end() ? 0 : found->second;
}

// The nodes of a graph but its scene, each in its place, that wait instead.
std::vector<Node> emulated_nodes(const Graph& graph, const EmulatedCosts& costs) {
    std::vector<Node> nodes;
    for (const auto& node : graph.nodes) {
        if (node.kind == "Scene") continue;
        if (node.name != "image") {
            nodes.push_back(emulated_light(node.name, cost_of(costs, node.name), inputs_of(node)));
            continue;
        }
        const double milliseconds = cost_of(costs, "image") * 1e-3 * costs.questions;
        nodes.push_back(emulated_image(milliseconds, costs.questions, inputs_of(node)));
        nodes.back().params["scene"] = Value{NodeRef{"scene"}};
    }
    return nodes;
}

// Seconds that one place would wait in all for a tile.
double emulated_seconds(const Graph& graph, const EmulatedCosts& costs) {
    const auto of_question = [&](const auto& again, const std::string& name) -> double {
        double microseconds = cost_of(costs, name);
        for (const auto& input : inputs_of(graph.nodes[graph.find(name).value()])) microseconds += again(again, input);
        return microseconds;
    };
    return 1e-6 * of_question(of_question, "image") * costs.questions;
}

}  // namespace

Graph paper_graph(const std::string& name, const std::map<std::string, std::string>& constants) {
    return load_graph(folder + name + ".lua", LuaOptions{constants});
}

Hosts paper_hosts(const std::string& name, const std::vector<std::string>& endpoints) {
    const auto file = folder + "hosts/" + name + ".lua";
    Hosts hosts = load_hosts(file);
    if (hosts.hosts.size() != endpoints.size()) throw std::runtime_error(file + " names other hosts");
    for (std::size_t i = 0; i < endpoints.size(); ++i) hosts.hosts[i].endpoint = endpoints[i];
    return hosts;
}

std::vector<double> emulated_efficiency(const std::string& graph_name, const std::string& hosts_name,
                                        const std::vector<std::uint32_t>& places, const EmulatedCosts& costs,
                                        std::size_t tiles) {
    constexpr std::uint64_t run_id = 1;
    const Registry standard{standard_nodes()}, kinds = emulated_kinds(nullptr, "");
    const Picture picture(standard, 64, 16);
    const Graph shipped = paper_graph(graph_name);
    std::deque<test::HostThread> daemons;
    Cluster::Options options;
    options.run = run_id;
    options.job = picture.of_nodes(shipped.file, emulated_nodes(shipped, costs));
    options.files = picture.files;
    std::uint32_t all_places = 0;
    for (const auto count : places) {
        options.endpoints.push_back(daemons.emplace_back(kinds, count).endpoint());
        all_places += count;
    }
    const Hosts hosts = paper_hosts(hosts_name, options.endpoints);
    const Graph graph = options.job.graph;
    options.plan = [&](const std::vector<HostOffer>& offers) { return plan(graph, kinds, hosts, offers); };
    const auto network = build_network(options.job, kinds, LoadedScene{});
    Cluster cluster(std::move(options));
    const std::atomic<bool> never{false};
    cluster.gather(std::chrono::seconds(10), never);
    cluster.adopt(cluster.plan());
    const double work = double(tiles) * emulated_seconds(graph, costs);
    std::vector<double> efficiency;
    for (int round = 0; round < repeated(3); ++round) {
        const double seconds = seconds_of_emulated(*network, run_id, cluster, cluster.plan(), tiles, 16);
        efficiency.push_back(work / (all_places * seconds));
    }
    cluster.finish();
    return efficiency;
}

}  // namespace lightnet::bench
