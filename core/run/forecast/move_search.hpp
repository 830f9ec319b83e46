// The search for a layout near the one in force: what may be gained by a few nodes that go from host to host.
#pragma once

#include <cstddef>
#include <vector>

#include "core/run/forecast/flow_estimate.hpp"
#include "core/run/forecast/host_options.hpp"

namespace lightnet {

/// Looks around the layout in force. What it is made of must outlive it.
class MoveSearch {
public:
    /// `kept`: what each host has in memory, which it will hold for a moment beside what comes; by host, by node.
    MoveSearch(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const LineCost& launcher,
               const HeldByHosts& kept);

    /// The best that steps lead to from `holds`: of one host, and of two at once; `holds` itself where nothing is
    /// better. The same each time. Ends after some hundredths of a second, however many hosts there are.
    HeldByHosts better_than(HeldByHosts holds);
    /// As FlowEstimate has it.
    double seconds(const HeldByHosts& holds);

private:
    std::vector<std::size_t> by_need() const;
    bool may_be(std::size_t host, const std::vector<bool>& held) const;
    bool takes(HeldByHosts& holds, const HeldByHosts& other);
    bool step_of_one(HeldByHosts& holds);
    bool step_of_two(HeldByHosts& holds);
    bool step_with(HeldByHosts& holds, std::size_t one, std::size_t two);

    const RunCosts& costs_;
    const std::vector<ForecastHost>& hosts_;
    const HeldByHosts& kept_;
    HostOptions options_;
    FlowEstimate estimate_;
    std::vector<double> busy_;  // by host, in the layout from which it steps
    double least_ = 0;          // seconds of that
    std::size_t steps_ = 0;
};

}  // namespace lightnet
