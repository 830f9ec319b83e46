#include "core/run/master/prepare_order.hpp"

#include "core/network/graph/layout.hpp"
#include "core/run/assembly/prepared.hpp"

namespace lightnet {

PrepareOrder::PrepareOrder(const Graph& graph, const Registry& registry)
    : graph_(graph),
      order_(preparing_nodes(graph, registry)),
      stages_(stages_of(order_, graph, registry)),
      renewed_(renewed_nodes(graph, registry)) {}

std::size_t PrepareOrder::end_of_stage(std::size_t done) const {
    std::size_t end = done;
    while (end < size() && stages_[end] <= done) ++end;
    return end;
}

std::vector<std::size_t> PrepareOrder::nodes_at(std::size_t position) const {
    auto nodes = sectors_of(graph_, order_[position]);
    if (nodes.empty()) nodes.push_back(order_[position]);
    return nodes;
}

std::vector<NodeCopy> PrepareOrder::copies(const Plan& plan, std::size_t position) const {
    std::vector<NodeCopy> copies;
    for (const auto node : nodes_at(position))
        for (const auto place : plan.places_of[node]) copies.push_back({plan.places[place], node});
    return copies;
}

}  // namespace lightnet
