#include "core/run/assembly/gauge.hpp"

namespace lightnet {

std::vector<AskingEdge> asking_edges(const Graph& graph, const Layers& layers, const Registry& registry) {
    std::vector<AskingEdge> edges;
    const auto inputs = edges_of(graph).inputs;
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
        for (const auto input : inputs[node]) edges.push_back({node, input});
        if (registry.find(graph.nodes[node].kind)->role != Role::image) continue;
        for (const auto shown : layers.shown) edges.push_back({node, shown});
    }
    return edges;
}

}  // namespace lightnet
