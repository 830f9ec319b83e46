// The log of a host, which strangers can have said much.
#pragma once

#include <chrono>
#include <functional>
#include <utility>
#include <vector>

#include "core/base/log_bounds.hpp"
#include "core/base/log_entry.hpp"

namespace lightnet {

/// So many lines of a kind in a minute, and what was left out as a number. One thread.
class BoundedLog {
public:
    using Time = LogBounds::Time;
    explicit BoundedLog(std::function<void(const LogEntry&)> tell) : tell_(std::move(tell)) {}

    void operator()(const LogEntry& entry);
    /// Lines that say how many were left out a minute ago or longer.
    std::vector<LogEntry> left_out(Time now);

private:
    static constexpr double lines_per_minute = 300;  // of one kind: a loop of short runs says two in .2 s
    static constexpr double refusals_per_minute = 20;

    std::function<void(const LogEntry&)> tell_;
    LogBounds lines_{lines_per_minute}, refusals_{refusals_per_minute};
};

}  // namespace lightnet
