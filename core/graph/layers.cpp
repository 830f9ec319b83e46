// Which layers a picture has, and which node keeps which of them apart.
#include <algorithm>
#include <cassert>

#include "core/graph/plan.hpp"

namespace lightnet {

std::size_t renderer_of(const Graph& graph, const Registry& registry) {
    for (std::size_t node = 0; node < graph.nodes.size(); ++node)
        if (const Kind* kind = registry.find(graph.nodes[node].kind); kind && kind->role == Role::image) return node;
    throw Error(graph.file, "no renderer");
}

namespace {

/// Collects terminals from the leaves up, for the nodes on additive paths only.
class Terminals {
public:
    Terminals(const Graph& graph, const Registry& registry)
        : graph_(graph), registry_(registry), of_(graph.nodes.size()) {}

    /// In graph order; every node comes here once.
    const std::vector<std::size_t>& below(std::size_t node) {
        auto& terminals = of_[node];
        if (!terminals.empty()) return terminals;
        const Kind* kind = registry_.find(graph_.nodes[node].kind);
        assert(kind && "only checked graphs have layers");
        if (!kind->linear && kind->role == Role::light) return terminals = {node};
        std::vector<std::size_t> all;
        for (const std::size_t input : graph_.inputs_of(node)) {
            const auto& part = below(input);
            all.insert(all.end(), part.begin(), part.end());
        }
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        return of_[node] = std::move(all);
    }

    std::vector<std::vector<std::size_t>> take() { return std::move(of_); }

private:
    const Graph& graph_;
    const Registry& registry_;
    std::vector<std::vector<std::size_t>> of_;
};

}  // namespace

std::vector<std::string> shown_names(const Layers& layers, const Graph& graph) {
    std::vector<std::string> names;
    for (const std::size_t node : layers.shown) names.push_back(graph.nodes[node].name);
    return names;
}

Layers layers_of(const Graph& graph, const Registry& registry) {
    const std::size_t renderer = renderer_of(graph, registry);
    Terminals terminals(graph, registry);
    Layers layers{{"emission"}, {}, {}};
    if (registry.find(graph.nodes[renderer].kind)->merges)
        layers.film = {graph.nodes[renderer].name};
    else
        for (const std::size_t terminal : terminals.below(renderer)) layers.film.push_back(graph.nodes[terminal].name);
    for (const std::size_t shown : graph.shown_by(renderer)) {
        const auto is_there = [&](const auto& all, const auto& one) {
            return std::find(all.begin(), all.end(), one) != all.end();
        };
        if (!is_there(layers.film, graph.nodes[shown].name) && !is_there(layers.shown, shown))
            layers.shown.push_back(shown);
    }
    layers.of_node = terminals.take();
    // whoever is on no additive path answers with one colour of its own
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
        const Kind* kind = registry.find(graph.nodes[node].kind);
        if (layers.of_node[node].empty() && kind->role == Role::light) layers.of_node[node] = {node};
    }
    return layers;
}

}  // namespace lightnet
