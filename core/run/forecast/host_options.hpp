// The sets of nodes that each host may hold: those that it has the memory for.
#pragma once

#include <cstddef>
#include <vector>

#include "core/run/forecast/run_costs.hpp"

namespace lightnet {

/// Has a host the memory for these nodes?
bool has_room(const RunCosts& costs, const ForecastHost& host, const std::vector<bool>& held);

/// The nodes that the picture needs.
std::vector<bool> needed_nodes(const RunCosts& costs);

/// The sets that are weighed for each host. What it is made of must outlive it.
class HostOptions {
public:
    HostOptions(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const std::vector<bool>& all);

    const std::vector<std::vector<bool>>& of(std::size_t host) const { return options_[host]; }
    /// With what its nodes take the frozen state of, which has to be beside them.
    std::vector<bool> with_taken(std::vector<bool> held) const;

private:
    std::vector<bool> closed(std::vector<bool> held) const;
    std::vector<std::size_t> weighed() const;
    void add(std::size_t host, const std::vector<bool>& held);

    const RunCosts& costs_;
    const std::vector<ForecastHost>& hosts_;
    std::vector<std::vector<std::vector<bool>>> options_;  // by host
};

}  // namespace lightnet
