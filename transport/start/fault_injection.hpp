// Faults that local workers may be given, to see what a run does about them.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>

namespace lightnet {

/// By the numbers of local workers, from 1 on.
struct FaultInjection {
    std::chrono::milliseconds delay{0};    // of all bytes between a worker and others, each way
    std::map<std::uint32_t, double> slow;  // makes all that it does take so many times as long
    std::map<std::uint32_t, double> lose;  // kills it when this share of the picture is there; it is started anew
};

}  // namespace lightnet
