// Runs of nodes whose cost is emulated.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/message/carrier.hpp"
#include "tests/bench/emulated_kinds.hpp"
#include "tests/bench/picture.hpp"

namespace lightnet::bench {

/// As emulated_kinds_with() has them; `slowness` is that of all nodes of kind `slow_kind`.
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
