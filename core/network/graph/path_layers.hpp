// Layers of an image that light path expressions name.
#pragma once

#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {

/// What the renderer's parameter `layers` makes of the colours that reach it.
struct PathLayers {
    std::vector<std::string> names;  // by colour: the layer that takes it; "": none, it has one of its own
    std::vector<Problem> problems;
};

/// `colours`: those of the image, its own first, before any expression put them together. What the graph's operators do
/// not keep apart can't be had, and is told: so are a path that two expressions have, and an expression without light.
PathLayers path_layers(const Graph& graph, const Registry& registry, const std::vector<Terminal>& colours,
                       const std::vector<bool>& by_group);

}  // namespace lightnet
