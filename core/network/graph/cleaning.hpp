// Nodes that a graph renders beside its image so that noise can be taken out of it: film = { …, clean = true }.
#pragma once

#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// The film of the graph's renderer says `clean = true`.
bool wants_cleaning(const Graph& graph, const Registry& registry);

/// Adds the features of what is seen to what the renderer shows, as nodes with the names that clean() looks for. Where
/// they are there already, nothing happens. For a sound graph; returns what is wrong with it for this end.
std::vector<Problem> add_cleaning(Graph& graph, const Registry& registry);

}  // namespace lightnet
