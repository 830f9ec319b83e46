// What is simulated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>

#include "core/network/graph/strategy.hpp"
#include "core/run/message/credit.hpp"

namespace lightnet::test {

/// What may happen in a simulated run, and how often.
struct World {
    std::uint64_t seed = 1;
    std::uint32_t hosts = 4;
    std::uint32_t places_per_host = 2;
    std::size_t tiles = 60;
    std::uint32_t blocks = 1;     // of samples, of each tile: at most a group of them
    double seconds_per_tile = 1;  // and block, of the fastest; others take up to eight times as long
    double delay = 0.005;         // of each message, at most
    double loss = 0;              // part of all messages
    double twice = 0;             // part of all replies
    double deaths = 0;            // per host and simulated second; a host comes back after some seconds
    double cuts = 0;              // likewise: only its line is gone
    double drains = 0;            // likewise, in good order
    double calm_after = 1e9;      // seconds; then nobody dies any more
    double hangs = 0;             // likewise: answers nothing for some time, and is never missed
    bool stand_ins = false;       // only the first host is lost, and asked while it is there; the others stand in
    std::set<std::uint32_t> poisonous{};  // tiles (by x) that kill the host that renders them
    Strategy strategy = Strategy::fastest;
    Credit credit{3, 3};
    bool remember = true;  // keep the story, for comparing
    std::size_t most_events = 2'000'000;
};

}  // namespace lightnet::test
