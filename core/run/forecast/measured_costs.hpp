// Costs of a run as they turn out while it goes on: at first those that were foreseen, then those that are measured.
#pragma once

#include <cstddef>
#include <vector>

#include "core/run/forecast/run_costs.hpp"
#include "core/run/forecast/run_window.hpp"

namespace lightnet {

/// One thread's. What it is made of must outlive it.
class MeasuredCosts {
public:
    MeasuredCosts(const RunCosts& foreseen, const std::vector<ForecastHost>& hosts);

    void take(const RunWindow& window);
    /// Of the network, with nothing left to prepare.
    RunCosts costs() const;
    /// How quick each host is now: as foreseen, times the share of the time that its threads wanted to run in which
    /// they did. Somebody else's work, a quota and a stopped process take the rest.
    std::vector<ForecastHost> hosts() const;

private:
    void take(std::size_t host, const HostWindow& window);

    const RunCosts& foreseen_;
    const std::vector<ForecastHost>& hosts_;
    std::vector<double> share_;  // by host
    // So far, the more the later: seconds at speed 1 by node, questions by edge, blocks.
    std::vector<double> work_, questions_;
    double blocks_ = 0;
    double prior_ = 1;  // blocks for which what was foreseen counts
};

}  // namespace lightnet
