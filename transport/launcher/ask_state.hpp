// Asks daemons and launchers how they are.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "transport/wire/machine.hpp"

namespace lightnet {

/// A host in words, as it (or the launcher that it serves) says.
struct HostAnswer {
    std::string asked;         // endpoint
    bool of_launcher = false;  // a launcher answers there, for a host of its run
    std::string name, state;
    std::string who;    // whose run it serves
    std::string nodes;  // that it holds
    Machine machine;
    std::uint64_t places = 0;
    std::uint64_t progress = 0;        // bundles and tiles answered in this run
    std::uint64_t bundles = 0;         // that came from other hosts in this run
    std::uint64_t broken_packets = 0;  // dropped
};

/// Asks all endpoints together, each once. One that does not answer within `patience` has the state "does not answer".
/// A launcher answers for all its hosts.
std::vector<HostAnswer> ask_state(const std::vector<std::string>& endpoints, std::chrono::milliseconds patience);

}  // namespace lightnet
