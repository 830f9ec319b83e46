// Asks daemons how the way to them is.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "transport/launcher/ask_state.hpp"

namespace lightnet {

/// What the way to a host is like. A value.
struct HostProbe {
    HostAnswer answer;                                    // of the host itself
    std::chrono::nanoseconds round_trip{};                // the shortest of some
    double bandwidth = 0;                                 // bytes per second from here to there; 0: not measured
    std::optional<std::chrono::nanoseconds> clock_ahead;  // of ours, within the round trip
    std::string plugins;                                  // that it has loaded
};

/// One after the other, so that they don't share the line; each at most `patience`. One that does not answer has the
/// state "does not answer", as with ask_state().
std::vector<HostProbe> probe_hosts(const std::vector<AskedHost>& hosts, std::chrono::milliseconds patience);

}  // namespace lightnet
