// The network on several threads of this process.
#pragma once

#include <cstdint>
#include <memory>

#include "core/run/message/carrier.hpp"
#include "core/run/prepare/assembly.hpp"
#include "core/run/runtime/place.hpp"

namespace lightnet {

/// N places in threads of this process, and the carrier with which the caller asks them. Used by one thread.
class ThreadedRun {
public:
    /// Returns when all places are ready.
    ThreadedRun(std::shared_ptr<const Network> network, std::uint64_t run, Plan plan, Tuning rules);
    ~ThreadedRun();

    Carrier& carrier();
    /// Throws Error when a place has died.
    void check();
    /// Stops all places and returns what they counted.
    Counters stop();

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace lightnet
