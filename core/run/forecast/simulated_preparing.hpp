// Preparing, before the first tile, on a simulated clock.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/network/graph/plan.hpp"
#include "core/run/forecast/run_costs.hpp"

namespace lightnet {

/// A value. Times are seconds since the hosts were there.
struct SimulatedPreparing {
    std::map<std::string, double> ready;  // when each host of the plan can answer for all that it holds
    double seconds = 0;                   // until every node has somebody who can answer for it
    std::vector<double> by_node;          // of them: for which node
    double work = 0;                      // of threads at speed 1
    double launcher_line = 0;             // in which that was busy
};

/// Shards are dealt out by real ShardDealers, and results go to each host once, over the launcher's line.
SimulatedPreparing simulate_preparing(const RunCosts& costs, const Plan& plan, const std::vector<ForecastHost>& hosts,
                                      const LineCost& launcher);

}  // namespace lightnet
