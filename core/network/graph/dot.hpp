// Draws a graph, and where it runs, in the language of Graphviz.
#pragma once

#include <map>
#include <string>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {

/// DOT text of a checked graph; the same graph and plan give the same bytes, and a node keeps its id whatever else
/// changes. Without a plan: the nodes, and what travels between them. With one: a cluster per host and place, each
/// replica, the multiplexers that choose among them, what sends questions to sectors, and how each edge travels.
/// `host_labels` (endpoint → label) says what to call hosts; those without one go by their endpoint. `pictures` (node →
/// PNG) says what to show in the boxes.
std::string to_dot(const Graph& graph, const Registry& registry, const Plan* plan = nullptr,
                   const std::map<std::string, std::string>& host_labels = {},
                   const std::map<std::string, std::string>& pictures = {});

}  // namespace lightnet
