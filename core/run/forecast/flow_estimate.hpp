// An estimate of how long a run takes, without playing it: questions as a flow between hosts.
#pragma once

#include <cstddef>
#include <vector>

#include "core/run/forecast/run_costs.hpp"

namespace lightnet {

/// Which nodes each host holds: by host, by node. All places of a host hold the same.
using HeldByHosts = std::vector<std::vector<bool>>;

/// Estimates many layouts of the same run on the same hosts. One thread's; what it is made of must outlive it.
class FlowEstimate {
public:
    FlowEstimate(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const LineCost& launcher);

    /// Seconds to prepare and to render; infinite where a node that the picture needs is nowhere.
    double seconds(const HeldByHosts& holds);
    /// By host, of the layout that was estimated last: how much each has to do, beside the others.
    const std::vector<double>& busy() const { return busy_; }
    /// How much work one estimate is, in steps of some nanoseconds.
    std::size_t steps() const { return rounds * (costs_.nodes.size() + costs_.edges.size()) * hosts_.size(); }

private:
    static constexpr std::size_t rounds = 8;  // in which work goes from who is busy to who is not

    double preparing(const HeldByHosts& holds) const;
    double flow(const HeldByHosts& holds);
    void answer(std::size_t node, const HeldByHosts& holds);
    bool is_relieved(std::size_t node, std::size_t host, const HeldByHosts& holds) const;
    double power(std::size_t host) const { return hosts_[host].power(); }

    const RunCosts& costs_;
    const std::vector<ForecastHost>& hosts_;
    LineCost launcher_;
    double blocks_;
    std::vector<double> weight_;              // by host: how much of what can be anywhere it gets
    std::vector<std::vector<double>> asked_;  // by node and host: questions that come up there
    std::vector<double> busy_, in_, out_;     // by host: seconds, and bytes on its line
};

}  // namespace lightnet
