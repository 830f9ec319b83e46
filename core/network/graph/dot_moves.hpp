// Nodes that went from host to host while a run went on, in its drawing.
#pragma once

#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {

/// A node that went to other hosts, or came to more of them, or left some. A value.
struct DrawnMove {
    std::string node;
    std::vector<std::string> from, to;  // hosts, as in the plan
    double seconds = 0;                 // since the run began
    friend bool operator==(const DrawnMove&, const DrawnMove&) = default;
};

/// What to_dot() says of a plan, with these moves beside it: a dashed box where a node was, and from there a dotted
/// arrow to each host that the plan gives it. A node that came to more hosts came from the launcher.
std::string with_moves(std::string dot, const Graph& graph, const Plan& plan, const std::vector<DrawnMove>& moves);

}  // namespace lightnet
