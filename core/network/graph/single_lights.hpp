// Lights of single nodes, which are what they are whatever else a graph has.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// The light of one node, in layers of the film of its own.
struct SingleLight {
    std::size_t node = 0;
    std::vector<std::size_t> layers;  // of the film
    std::vector<bool> used;           // per node of the graph, whether it hangs on that, the renderer aside
    std::string text;  // of these and of the renderer, as far as it hangs on them, but for film and samples
};

// DECISIONS: lights-by-recipe
/// Those of a checked graph, in its order. None where the renderer does not say what its questions hang on, where cells
/// decide about samples by all layers, where layers are light path expressions, or where anything rehearses, which
/// notes questions of all.
std::vector<SingleLight> single_lights(const Graph& graph, const Registry& registry);

/// The graph with nodes that answer black in the place of those. Lights are taken out of `known` where others ask their
/// nodes, too, whose light is still wanted. The layers of the image stay as they are called.
Graph without_lights(const Graph& graph, const Registry& registry, std::vector<SingleLight>& known);
/// It with nodes that answer black for all that prepare, or ask somebody who does: what is left shows at once.
Graph without_preparing(const Graph& graph, const Registry& registry);
/// Is anything left out of it?
bool leaves_out(const Graph& graph);

}  // namespace lightnet
