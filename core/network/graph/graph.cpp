#include "core/network/graph/graph.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <unordered_map>

namespace lightnet {

std::optional<std::size_t> Graph::find(std::string_view name) const {
    const auto at = std::find_if(nodes.begin(), nodes.end(), [&](const Node& node) { return node.name == name; });
    if (at == nodes.end()) return std::nullopt;
    return static_cast<std::size_t>(at - nodes.begin());
}

namespace {

using Find = std::function<std::optional<std::size_t>(std::string_view)>;
using Nodes = std::vector<std::size_t>;

void add_named(const List& values, const Find& find, Nodes& nodes) {
    for (const auto& value : values)
        if (const auto* ref = std::get_if<NodeRef>(&value.data))
            if (const auto node = find(ref->name)) nodes.push_back(*node);
}

Nodes inputs_of(const Node& node, const Find& find) {
    Nodes inputs;
    add_named(node.entries, find, inputs);
    return inputs;
}

Nodes shown_by(const Node& node, const Find& find) {
    Nodes shown;
    for (const auto& [name, value] : node.params)
        if (const auto* table = std::get_if<Table>(&value.data)) add_named(table->list, find, shown);
    return shown;
}

// Nodes that parameters name: scenes, or those whose frozen state is taken.
Nodes named_by(const Graph& graph, const Node& node, const Find& find, bool scenes) {
    Nodes named;
    for (const auto& [name, value] : node.params)
        if (const auto* ref = std::get_if<NodeRef>(&value.data))
            if (const auto other = find(ref->name); other && (graph.nodes[*other].kind == "Scene") == scenes)
                named.push_back(*other);
    return named;
}

Nodes together(Nodes nodes, const Nodes& shown, const Nodes& taken) {
    nodes.insert(nodes.end(), shown.begin(), shown.end());
    nodes.insert(nodes.end(), taken.begin(), taken.end());
    return nodes;
}

Find finder(const Graph& graph) {
    return [&graph](std::string_view name) { return graph.find(name); };
}

std::size_t references_in(const Value& value);

std::size_t references_in(const List& list) {
    return std::accumulate(list.begin(), list.end(), std::size_t{0},
                           [](std::size_t sum, const Value& value) { return sum + references_in(value); });
}

// Tables stand in tables some levels deep at most, whoever wrote them.
std::size_t references_in(const Value& value) {
    if (std::holds_alternative<NodeRef>(value.data)) return 1;
    const auto* table = std::get_if<Table>(&value.data);
    std::size_t sum = table ? references_in(table->list) : 0;
    if (table)
        for (const auto& [name, entry] : table->named) sum += references_in(entry);
    return sum;
}

}  // namespace

std::vector<std::size_t> Graph::inputs_of(std::size_t node) const {
    return lightnet::inputs_of(nodes[node], finder(*this));
}

std::vector<std::size_t> Graph::shown_by(std::size_t node) const {
    return lightnet::shown_by(nodes[node], finder(*this));
}

std::vector<std::size_t> Graph::taken_by(std::size_t node) const {
    return named_by(*this, nodes[node], finder(*this), false);
}

std::vector<std::size_t> Graph::needed_by(std::size_t node) const {
    return together(inputs_of(node), shown_by(node), taken_by(node));
}

Edges edges_of(const Graph& graph) {
    std::unordered_map<std::string_view, std::size_t> index;
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) index.emplace(graph.nodes[node].name, node);
    const Find find = [&](std::string_view name) -> std::optional<std::size_t> {
        const auto at = index.find(name);
        return at == index.end() ? std::nullopt : std::optional(at->second);
    };
    Edges edges;
    for (const Node& node : graph.nodes) {
        edges.inputs.push_back(inputs_of(node, find));
        edges.taken.push_back(named_by(graph, node, find, false));
        edges.scenes.push_back(named_by(graph, node, find, true));
        edges.needed.push_back(together(edges.inputs.back(), shown_by(node, find), edges.taken.back()));
    }
    return edges;
}

std::size_t references_in(const Graph& graph) {
    std::size_t sum = 0;
    for (const Node& node : graph.nodes) {
        sum += references_in(node.entries);
        for (const auto& [name, value] : node.params) sum += references_in(value);
    }
    return sum;
}

std::vector<std::size_t> leaves_first(const Edges& edges) {
    const std::size_t count = edges.needed.size();
    std::vector<std::size_t> missing(count), order;
    std::vector<Nodes> askers(count);
    for (std::size_t node = 0; node < count; ++node) {
        missing[node] = edges.needed[node].size();
        for (const auto needed : edges.needed[node]) askers[needed].push_back(node);
        if (missing[node] == 0) order.push_back(node);
    }
    for (std::size_t next = 0; next < order.size(); ++next)
        for (const auto asker : askers[order[next]])
            if (--missing[asker] == 0) order.push_back(asker);
    return order;
}

std::vector<unsigned> ranks_of(const Graph& graph) {
    const Edges edges = edges_of(graph);
    const auto order = leaves_first(edges);
    if (order.size() < graph.nodes.size()) throw Error(graph.file, "the graph has a cycle, so its nodes have no ranks");
    std::vector<unsigned> ranks(graph.nodes.size(), 0);
    for (const auto node : order)
        for (const auto needed : edges.needed[node]) ranks[node] = std::max(ranks[node], ranks[needed] + 1);
    return ranks;
}

std::vector<bool> used_nodes(const Graph& graph, std::size_t renderer) {
    const Edges edges = edges_of(graph);
    std::vector<bool> used(graph.nodes.size(), false);
    Nodes open{renderer};
    used[renderer] = true;
    const auto reach = [&](const Nodes& nodes) {
        for (const auto node : nodes) {
            if (!used[node]) open.push_back(node);
            used[node] = true;
        }
    };
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        reach(edges.needed[node]);
        reach(edges.scenes[node]);
    }
    return used;
}

}  // namespace lightnet
