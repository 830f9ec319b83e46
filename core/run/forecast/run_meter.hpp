// Figures of hosts, which only grow, as windows of a run.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/run/assembly/gauge.hpp"
#include "core/run/forecast/run_costs.hpp"
#include "core/run/forecast/run_window.hpp"
#include "core/run/message/figures.hpp"

namespace lightnet {

/// One thread's. `costs` must outlive it; its nodes are those of the graph.
class RunMeter {
public:
    /// `edges`: asking_edges(), as hosts count them. `hosts`: how many there are.
    RunMeter(const RunCosts& costs, const std::vector<AskingEdge>& edges, std::size_t hosts);

    /// What a host has counted so far; `there`: it takes part.
    void see(std::size_t host, bool there, const HostFigures& figures);
    /// What came since the last call. `done`: of the picture, so far: 0 to 1.
    RunWindow next(double done);

private:
    struct Seen {
        bool there = false;
        HostFigures last{}, now{};
    };
    HostWindow window_of(const Seen& seen) const;
    void count_questions(const Seen& seen, std::vector<double>& questions) const;

    const RunCosts& costs_;
    std::vector<std::optional<std::size_t>> counted_as_;  // by edge of hosts: by edge of the costs
    std::vector<Seen> hosts_;
    double done_ = 0;
};

}  // namespace lightnet
