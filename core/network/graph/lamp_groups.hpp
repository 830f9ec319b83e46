// Groups of lamps, as a graph names them.
#pragma once

#include <string>
#include <vector>

#include "core/base/lamp_groups.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// The names in a value of type ParamType::names.
std::vector<std::string> names_in(const Value& value);

/// The groups that the scene of the graph's renderer has, by name, and `rest` behind them; empty where it has none.
std::vector<std::string> lamp_groups(const Graph& graph, const Registry& registry);

/// Those that a node looks for. All where it names none, or none that is there.
GroupSet groups_wanted(const Node& node, const std::vector<std::string>& groups);

/// Does a node keep the groups apart by itself?
bool asks_for_groups(const Node& node);

/// Per node, whether its answers keep groups of lamps apart: a linear one does where all its inputs do.
std::vector<bool> keep_groups(const Graph& graph, const Registry& registry);

/// What is wrong with the groups of a graph that is sound otherwise.
std::vector<Problem> mistaken_groups(const Graph& graph, const Registry& registry);

}  // namespace lightnet
