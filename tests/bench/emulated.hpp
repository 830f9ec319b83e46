// Nodes whose cost is emulated: they wait in their place as long as real ones would compute, and leave the processor to
// the others, so that one machine can play many.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/message/carrier.hpp"
#include "tests/bench/picture.hpp"

namespace lightnet::bench {

/// How many times slower than usual each replica of a node is, in the order in which they are made.
struct Slowness {
    std::vector<double> of_replica;                        // others: 1
    std::chrono::steady_clock::time_point slowed_at = {};  // from then on ...
    int slowed = -1;                                       // ... this one is ten times slower; -1: none
    std::atomic<int> made{0};

    double of(int replica) const;
};

/// `EmulatedLight { inputs…, microseconds = per question }` adds its inputs up; `EmulatedImage { inputs…, milliseconds
/// = per tile, questions = per tile }` asks them. `slowness` is that of all nodes of kind `slow_kind`.
Registry emulated_kinds(std::shared_ptr<Slowness> slowness, const std::string& slow_kind);

/// A node of such a graph.
Node emulated_light(const std::string& name, double microseconds, const std::vector<std::string>& inputs = {});
Node emulated_image(double milliseconds, double questions, const std::vector<std::string>& inputs = {});

/// Seconds until a master has `tiles` tiles of one pixel from the places of `plan`. `counters`, if wanted, are the
/// master's.
double seconds_of_emulated(const Network& network, std::uint64_t run, Carrier& carrier, const Plan& plan,
                           std::size_t tiles, std::size_t in_flight, Counters* counters = nullptr);

/// Every place a renderer, nothing else: that many threads, and so many seconds for that many tiles each.
double seconds_of_places(std::uint32_t places, double milliseconds, std::size_t tiles,
                         std::shared_ptr<Slowness> slowness = std::make_shared<Slowness>());

/// The same on hosts that know emulated nodes, over tcp, from when all are ready.
double seconds_of_hosts(const std::vector<std::string>& endpoints, const Picture& picture, std::size_t places,
                        double milliseconds, std::size_t tiles);

}  // namespace lightnet::bench
