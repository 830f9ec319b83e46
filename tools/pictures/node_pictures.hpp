// The picture of each node, for a drawing of the graph.
#pragma once

#include <map>
#include <string>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// Writes, as PNG beside the picture `exr` (x.direct.png beside x.exr), what it has of each node of its checked graph:
/// a layer, what was shown beside the sum, all light for the renderer's input, and the whole for the renderer. What is
/// no light is scaled so that hardly any pixel is brighter than white. Returns the file of each node that has one.
/// Throws Error.
std::map<std::string, std::string> write_node_pictures(const Graph& graph, const Registry& registry,
                                                       const std::string& exr);

}  // namespace lightnet
