#include "tools/session/run_figures.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <utility>

#include "core/base/processor_time.hpp"
#include "core/network/graph/layout.hpp"

namespace lightnet {
namespace {

double in_seconds(std::uint64_t ns) { return static_cast<double>(ns) * 1e-9; }

// "photons#2" is a part of "photons".
std::string whole_name(const std::string& node) { return node.substr(0, node.find('#')); }

struct NodeSum {
    NodeRecord figures;
    std::uint64_t questions = 0, called_ns = 0, calling_ns = 0;
    std::map<std::string, std::uint64_t> prepare_ns{};  // by host: copies of one host do it together
};

void add_node(NodeSum& sum, const std::string& host, const NodeRecord& more) {
    sum.figures.answered += more.answered;
    sum.figures.busy_ns += more.busy_ns;
    sum.figures.bundles += more.bundles;
    sum.figures.replies += more.replies;
    sum.figures.latency_ns += more.latency_ns;
    sum.figures.shards = std::max(sum.figures.shards, more.shards);
    sum.figures.rounds = std::max(sum.figures.rounds, more.rounds);
    sum.figures.shard_ns += more.shard_ns;
    auto& of_host = sum.prepare_ns[host];
    of_host += more.prepare_ns;
    sum.figures.prepare_ns = std::max(sum.figures.prepare_ns, of_host);
    sum.figures.prepared = std::max(sum.figures.prepared, more.prepared);
    sum.figures.costs.add(more.costs);
}

void fill(NodeReport& node, const NodeSum& sum) {
    const std::uint64_t all = sum.figures.busy_ns + sum.called_ns;
    node.questions = sum.questions;
    node.answered = sum.figures.answered;
    node.bundles = sum.figures.bundles;
    node.seconds = in_seconds(all);
    node.own_seconds = in_seconds(all - std::min(all, sum.calling_ns));
    node.shards = {sum.figures.shards, sum.figures.rounds, in_seconds(sum.figures.shard_ns),
                   in_seconds(sum.figures.prepare_ns), sum.figures.prepared};
    for (const auto& [step, count] : sum.figures.costs.counts)
        node.spread.emplace_back(1e-9 * CostSpread::ns_of(step), count);
    if (sum.figures.replies) node.latency = in_seconds(sum.figures.latency_ns) / double(sum.figures.replies);
}

void fill(PlaceReport& place, const PlaceRecord& record) {
    place.seconds = in_seconds(record.lived_ns);
    place.waiting = in_seconds(record.waited_ns);
    place.idle = in_seconds(record.idle_ns);
}

}  // namespace

std::vector<NodeReport> nodes_without_figures(const Graph& graph) {
    std::vector<NodeReport> nodes;
    for (std::size_t i = 0; i < written_nodes(graph); ++i)
        if (graph.nodes[i].kind != "Scene") nodes.push_back({graph.nodes[i].name, graph.nodes[i].kind});
    return nodes;
}

std::vector<LayerReport> light_of_layers(const Picture& picture) {
    std::vector<LayerReport> layers;
    double all = 0;
    for (const auto& layer : picture.layers) {
        double sum = 0;
        for (const auto& colour : layer.pixels) sum += double(luminance(layer.gain * colour));
        layers.push_back({layer.name, layer.pixels.empty() ? 0 : sum / double(layer.pixels.size()), 0});
        all += layers.back().mean;
    }
    for (auto& layer : layers) layer.share = all > 0 ? layer.mean / all : 0;
    return layers;
}

void add_figures(RunReport& report, const std::vector<PlaceRecord>& records) {
    std::map<std::string, NodeSum> nodes;
    std::map<std::pair<std::string, std::string>, EdgeRecord> edges;
    for (const auto& record : records) {
        for (const auto& [name, figures] : record.nodes) add_node(nodes[whole_name(name)], record.host, figures);
        for (const auto& [ends, more] : record.edges) {
            auto& edge = edges[{whole_name(ends.first), whole_name(ends.second)}];
            edge.asks += more.asks, edge.questions += more.questions;
            edge.called_ns += more.called_ns, edge.waited_ns += more.waited_ns;
            edge.bundles += more.bundles, edge.sent += more.sent, edge.bytes += more.bytes;
            edge.learning += more.learning, edge.learning_ns += more.learning_ns;
        }
        for (auto& place : report.places)
            if (place.index == record.index &&
                (place.host == record.host || (record.host.empty() && place.host == "here")))
                fill(place, record);
    }
    for (const auto& [ends, edge] : edges) {
        nodes[ends.second].questions += edge.questions;
        nodes[ends.second].called_ns += edge.called_ns;
        nodes[ends.first].calling_ns += edge.called_ns;
        report.edges.push_back({ends.first, ends.second, edge.asks, edge.questions, in_seconds(edge.called_ns),
                                in_seconds(edge.waited_ns), edge.bundles, edge.sent, edge.bytes, edge.learning,
                                in_seconds(edge.learning_ns)});
    }
    for (auto& node : report.nodes) fill(node, nodes[node.name]);
}

double seconds_of_this_thread() { return std::chrono::duration<double>(thread_processor_time()).count(); }

}  // namespace lightnet
