// What is said while a run waits for hosts that serve another one.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "transport/cluster.hpp"

namespace lightnet {

/// Says from time to time who is busy, with whose run, and how long the wait has been. One thread's; looks at no clock.
class Waiting {
public:
    using Time = std::chrono::steady_clock::time_point;

    explicit Waiting(Time begun) : begun_(begun), next_(begun + first) {}
    /// What is to be said now, if anything.
    std::optional<std::string> words(const std::vector<HostState>& hosts, Time now);

private:
    static constexpr std::chrono::seconds first{5}, longest{60};
    Time begun_, next_;
    std::chrono::seconds pause_ = first;  // grows: who waits for an hour doesn't want a thousand lines
};

/// Why a host waits, as it says ("it serves another run, of anna@vm (lab.lua)"); none: it doesn't.
std::optional<std::string> why_it_waits(const std::string& state);

}  // namespace lightnet
