// Seconds of the phases of a run, and of what its nodes did while they prepared.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "core/run/assembly/prepare_progress.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

/// Writes into a report, which outlives it. One phase goes on at a time, and one thing that nodes do. One thread's.
class PhaseTimes {
public:
    using Time = std::chrono::steady_clock::time_point;

    explicit PhaseTimes(RunReport& report) : report_(report) {}

    /// The one before has ended.
    void begin(const std::string& name, Time now);
    /// Whatever goes on ends.
    void end(Time now);
    /// The phase that is last.
    bool is(const std::string& name) const { return !report_.phases.empty() && report_.phases.back().name == name; }
    /// What a node does now. True: it is another one than before.
    bool preparing(const PrepareProgress& progress, Time now);
    /// When the phase that goes on began.
    std::optional<Time> begun() const { return begun_; }
    Time run_begun() const { return run_begun_; }

private:
    void end_doing(Time now);

    RunReport& report_;
    std::optional<Time> begun_, doing_since_;  // the last phase; the last entry of `preparing`
    std::string last_prepared_;                // node
    Time run_begun_ = std::chrono::steady_clock::now();
};

}  // namespace lightnet
