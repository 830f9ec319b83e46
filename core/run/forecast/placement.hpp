// The choice of which host holds which nodes: a pure function of what they cost and of what hosts are like.
#pragma once

#include <string>
#include <vector>

#include "core/network/graph/hosts.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/forecast/flow_estimate.hpp"
#include "core/run/forecast/host_options.hpp"

namespace lightnet {

/// A layout. A value.
struct NodeLayout {
    HeldByHosts holds;
    double seconds = 0;            // as estimated
    std::vector<std::string> why;  // a sentence for each node that is not everywhere, and for what else was weighed
};

/// Every place of a host holds what that holds.
Plan plan_of(const HeldByHosts& holds, const std::vector<ForecastHost>& hosts);
/// The entries of a hosts file that say the same; one that holds all names nothing. `known`: what such a file has said
/// of them beside nodes, as keys.
Hosts hosts_of(const HeldByHosts& holds, const RunCosts& costs, const std::vector<ForecastHost>& hosts, Hosts known);

/// Beside them the other hosts of `known`, which hold nothing: they take part, as nodes may come to them later (Mover).
/// But for this process.
Hosts with_empty_hosts(const Hosts& said, const RunCosts& costs, Hosts known);

/// Everything everywhere where memory allows and nothing else is clearly quicker; else what an estimate finds best,
/// and of the best few what forecast() does, where there are few hosts and nodes. Who takes a node's frozen state has
/// that beside it. Throws Error where a node fits no host.
NodeLayout place_nodes(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const LineCost& launcher);

}  // namespace lightnet
