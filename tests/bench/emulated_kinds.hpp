// Nodes whose cost is emulated: they wait in their place as long as real ones would compute, and leave the processor to
// the others, so that one machine can play many.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <vector>

#include "core/network/graph/kind.hpp"

namespace lightnet::bench {

/// How many times slower than usual each replica of a node is, in the order in which they are made.
struct Slowness {
    std::vector<double> of_replica;
    double of_others = 1;
    std::chrono::steady_clock::time_point slowed_at = {};  // from then on ...
    int slowed = -1;                                       // ... this one is ten times slower; -1: none
    std::atomic<int> made{0};

    double of(int replica) const;
};

/// `EmulatedLight { inputs…, microseconds = per question }` adds its inputs up; `EmulatedImage { inputs…, milliseconds
/// = per tile, questions = per tile }` asks them. Null: at the usual speed.
std::vector<Kind> emulated_kinds_with(std::shared_ptr<Slowness> light, std::shared_ptr<Slowness> image);

}  // namespace lightnet::bench
