// Keeps book of which light paths a graph counts, so that operators can be combined without counting light twice.
#pragma once

#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/path_set.hpp"

namespace lightnet {

/// What check() says about the light paths of a graph.
struct PathReport {
    std::vector<Problem> doubles;  // paths that two nodes count
    std::vector<Problem> missing;  // paths that no node counts: legitimate, but good to know
};

/// Follows the light of all nodes to the renderer of a sound graph. Combine adds up its inputs' paths; a node that
/// gathers (its kind's `onward`) continues them. Light that passes a node which gives a part of it only (Scale, Select,
/// a weight other than 1) was divided on purpose: it counts as there, and never as doubled. Where a kind doesn't state
/// its paths, nothing is known to be missing.
PathReport report_paths(const Graph& graph, const Registry& registry);

/// One node's light as it arrives at the image by way of linear nodes.
struct ArrivingPaths {
    std::vector<PathSet> by_group;  // of lamps; one where the scene has none
    bool known = true;              // all are stated
};

/// Of each of these nodes, which pass on no other's light as it is; of the renderer its own.
std::vector<ArrivingPaths> paths_at_image(const Graph& graph, const Registry& registry,
                                          const std::vector<std::size_t>& nodes);

/// The paths that a node states, for display: "L(D|V)", "… D" (the inputs' paths, continued), or "" if its kind states
/// none. `node` has its defaults.
std::string paths_text(const Node& node, const Kind& kind);

}  // namespace lightnet
