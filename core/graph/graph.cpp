#include "core/graph/graph.hpp"

#include <algorithm>

namespace lightnet {

std::optional<std::size_t> Graph::find(std::string_view name) const {
    const auto at = std::find_if(nodes.begin(), nodes.end(), [&](const Node& node) { return node.name == name; });
    if (at == nodes.end()) return std::nullopt;
    return static_cast<std::size_t>(at - nodes.begin());
}

std::vector<std::size_t> Graph::inputs_of(std::size_t node) const {
    std::vector<std::size_t> inputs;
    for (const auto& entry : nodes[node].entries)
        if (const auto* ref = std::get_if<NodeRef>(&entry.data))
            if (const auto input = find(ref->name)) inputs.push_back(*input);
    return inputs;
}

std::vector<std::size_t> Graph::shown_by(std::size_t node) const {
    std::vector<std::size_t> shown;
    for (const auto& [name, value] : nodes[node].params)
        if (const auto* table = std::get_if<Table>(&value.data))
            for (const auto& entry : table->list)
                if (const auto* ref = std::get_if<NodeRef>(&entry.data))
                    if (const auto other = find(ref->name)) shown.push_back(*other);
    return shown;
}

std::vector<std::size_t> Graph::taken_by(std::size_t node) const {
    std::vector<std::size_t> taken;
    for (const auto& [name, value] : nodes[node].params)
        if (const auto* ref = std::get_if<NodeRef>(&value.data))
            if (const auto other = find(ref->name); other && nodes[*other].kind != "Scene") taken.push_back(*other);
    return taken;
}

std::vector<std::size_t> Graph::needed_by(std::size_t node) const {
    auto needed = inputs_of(node);
    for (const auto& more : {shown_by(node), taken_by(node)}) needed.insert(needed.end(), more.begin(), more.end());
    return needed;
}

std::vector<unsigned> ranks_of(const Graph& graph) {
    std::vector<unsigned> ranks(graph.nodes.size(), 0);
    // each round settles at least one more rank; a graph without cycles needs no more rounds than nodes
    for (std::size_t round = 0; round < graph.nodes.size(); ++round) {
        bool settled = true;
        for (std::size_t node = 0; node < graph.nodes.size(); ++node)
            for (const std::size_t input : graph.needed_by(node))
                if (ranks[node] <= ranks[input]) {
                    ranks[node] = ranks[input] + 1;
                    settled = false;
                }
        if (settled) return ranks;
    }
    if (graph.nodes.empty()) return ranks;
    throw Error(graph.file, "the graph has a cycle, so its nodes have no ranks");
}

std::vector<bool> used_nodes(const Graph& graph, std::size_t renderer) {
    std::vector<bool> used(graph.nodes.size(), false);
    std::vector<std::size_t> open{renderer};
    const auto reach = [&](const Value& value) {
        if (const auto* ref = std::get_if<NodeRef>(&value.data))
            if (const auto node = graph.find(ref->name); node && !used[*node]) open.push_back(*node);
    };
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        used[node] = true;
        for (const auto& entry : graph.nodes[node].entries) reach(entry);
        for (const auto& [name, value] : graph.nodes[node].params) reach(value);
        for (const std::size_t shown : graph.shown_by(node))
            if (!used[shown]) open.push_back(shown);
    }
    return used;
}

}  // namespace lightnet
