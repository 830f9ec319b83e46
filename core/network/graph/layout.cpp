#include "core/network/graph/layout.hpp"

#include <algorithm>
#include <numeric>

#include "core/base/error.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {
namespace {

// Later entries win, and those of a node over those of all.
std::optional<Layout> layout_of(const Hosts& hosts, const std::string& node) {
    std::optional<Layout> layout;
    for (const std::string& wanted : {std::string(), node})
        for (const auto& entry : hosts.layouts)
            if (entry.node == wanted)
                if (const auto named = layout_called(entry.name)) layout = named;
    return layout;
}

std::size_t bytes_of(const Value& value);

std::size_t bytes_of(const List& list) {
    std::size_t sum = 0;
    for (const auto& value : list) sum += bytes_of(value);
    return sum;
}

std::size_t bytes_of(const std::map<std::string, Value>& named) {
    std::size_t sum = 0;
    for (const auto& [name, value] : named) sum += name.size() + bytes_of(value);
    return sum;
}

// About what a value takes. Tables stand in tables some levels deep at most.
std::size_t bytes_of(const Value& value) {
    std::size_t sum = sizeof(Value);
    if (const auto* text = std::get_if<std::string>(&value.data)) sum += text->size();
    if (const auto* ref = std::get_if<NodeRef>(&value.data)) sum += ref->name.size();
    if (const auto* table = std::get_if<Table>(&value.data)) sum += bytes_of(table->list) + bytes_of(table->named);
    return sum;
}

// Each sector is a copy of its node. A stranger may have written both.
constexpr std::size_t most_bytes_of_sectors = std::size_t{128} << 20;

std::size_t bytes_of(const Node& node) {
    return sizeof(Node) + node.name.size() + node.kind.size() + node.where.file.size() + bytes_of(node.entries) +
           bytes_of(node.params);
}

}  // namespace

std::vector<std::uint32_t> sectors_by_host(const Hosts& hosts, const std::string& node) {
    std::vector<std::uint32_t> counts;
    for (const auto& host : hosts.hosts) {
        const auto named = host.replicas.find(node);
        const int replicas = named == host.replicas.end() ? 0 : std::max(named->second, 0);
        counts.push_back(host.replicas.empty() ? 1 : static_cast<std::uint32_t>(replicas));
    }
    return counts;
}

bool is_taken(const Graph& graph, std::size_t node) {
    for (std::size_t taker = 0; taker < graph.nodes.size(); ++taker) {
        const auto taken = graph.taken_by(taker);
        if (std::find(taken.begin(), taken.end(), node) != taken.end()) return true;
    }
    return false;
}

std::map<std::string, std::uint32_t> shards_of(const Graph& graph, const Registry& registry, const Hosts& hosts) {
    std::map<std::string, std::uint32_t> shards;
    const auto used = used_nodes(graph, renderer_of(graph, registry));
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
        const auto& [name, kind, entries, params, where] = graph.nodes[node];
        if (!used[node] || !registry.find(kind)->run.landmarks || layout_of(hosts, name) != Layout::sharded) continue;
        if (is_taken(graph, node)) continue;  // whoever takes its frozen state needs all of it
        const auto counts = sectors_by_host(hosts, name);
        const auto count = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
        if (count > 1) shards[name] = static_cast<std::uint32_t>(std::min<std::uint64_t>(count, most_sectors));
    }
    return shards;
}

Graph sharded(Graph graph, const std::map<std::string, std::uint32_t>& shards) {
    if (!graph.sectors.empty()) throw Error(graph.file, "a graph is sharded once");
    std::size_t bytes = 0;
    for (const auto& [name, count] : shards) {
        const auto whole = graph.find(name);
        if (!whole) throw Error(graph.file, "'" + name + "' is to be sharded, but there is no such node");
        if (count < 2 || count > most_sectors || graph.sectors.size() + count > 16 * most_sectors)
            throw Error(graph.file, "'" + name + "' can't have " + std::to_string(count) + " sectors");
        bytes += count * bytes_of(graph.nodes[*whole]);
        if (bytes > most_bytes_of_sectors)
            throw Error(graph.file, "'" + name + "' has too many parameters to be sharded " + std::to_string(count) +
                                        " times: its sectors would take " + std::to_string(bytes >> 20) + " MiB");
        for (std::uint32_t index = 0; index < count; ++index) {
            Node node = graph.nodes[*whole];
            node.name += "#" + std::to_string(index + 1);
            graph.nodes.push_back(std::move(node));
            graph.sectors.push_back({static_cast<std::uint32_t>(*whole), index, count});
        }
    }
    return graph;
}

std::map<std::string, std::uint32_t> shards_in(const Graph& graph) {
    std::map<std::string, std::uint32_t> shards;
    for (const auto& sector : graph.sectors) shards[graph.nodes[sector.node].name] = sector.count;
    return shards;
}

std::size_t written_nodes(const Graph& graph) { return graph.nodes.size() - graph.sectors.size(); }

Graph written(Graph graph) {
    graph.nodes.resize(written_nodes(graph));
    graph.sectors.clear();
    return graph;
}

std::vector<std::size_t> sectors_of(const Graph& graph, std::size_t node) {
    std::vector<std::size_t> sectors;
    for (std::size_t i = 0; i < graph.sectors.size(); ++i)
        if (graph.sectors[i].node == node) sectors.push_back(written_nodes(graph) + i);
    return sectors;
}

const Sector* sector_at(const Graph& graph, std::size_t node) {
    const std::size_t written = written_nodes(graph);
    return node < written ? nullptr : &graph.sectors[node - written];
}

std::size_t whole_of(const Graph& graph, std::size_t node) {
    const auto* sector = sector_at(graph, node);
    return sector ? sector->node : node;
}

}  // namespace lightnet
