// Finds everything that is wrong with a graph, before any work starts.
#pragma once

#include "core/graph/graph.hpp"
#include "core/graph/hosts.hpp"
#include "core/graph/kind.hpp"

namespace lightnet {

/// The graph with defaults filled in. Throws UserError that names *all* problems, each with file, line, the node's name
/// and a suggestion: unknown kind or parameter, wrong type or range, missing input, wrong role of an input, duplicate
/// name, cycle, no or several renderers, and nodes in `hosts` that the graph does not have.
Graph check(const Graph& graph, const Registry& registry, const Hosts& hosts = {});

}  // namespace lightnet
