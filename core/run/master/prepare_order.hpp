// The order in which nodes prepare.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/master/node_copy.hpp"

namespace lightnet {

/// Positions of the nodes that prepare, inputs first. Those of one stage, see stages_of(), prepare at the same time;
/// what stands for the sectors of a node has its position. Constant.
class PrepareOrder {
public:
    PrepareOrder(const Graph& graph, const Registry& registry);

    std::size_t size() const { return order_.size(); }
    std::size_t node(std::size_t position) const { return order_[position]; }
    const std::string& name(std::size_t position) const { return graph_.nodes[order_[position]].name; }
    /// The first position of its stage: all before that are prepared before it.
    std::size_t stage(std::size_t position) const { return stages_[position]; }
    /// Behind the stage that is led when so many positions are done.
    std::size_t end_of_stage(std::size_t done) const;
    /// The node itself, or those that stand for its sectors.
    std::vector<std::size_t> nodes_at(std::size_t position) const;
    /// All copies of these in a plan.
    std::vector<NodeCopy> copies(const Plan& plan, std::size_t position) const;
    /// Does it learn anew for each pass?
    bool is_renewed(std::size_t position) const { return renewed_[order_[position]]; }

private:
    const Graph& graph_;
    std::vector<std::size_t> order_, stages_;
    std::vector<bool> renewed_;  // by node
};

}  // namespace lightnet
