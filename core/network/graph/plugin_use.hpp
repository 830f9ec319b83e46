// Plugins that a graph needs: part of what hosts of one run must have in common.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// Those of a registry's plugins whose kinds a graph uses: "glow 1.0 (0f3a…)".
std::set<std::string> plugins_of(const Graph& graph, const Registry& registry);

/// Why a run that needs `wanted` can't be served with `registry`: all of them that differ, and what to do. "": it can.
std::string why_plugins_differ(const std::vector<std::string>& wanted, const Registry& registry);

}  // namespace lightnet
