// The network on several threads of this process.
#pragma once

#include <cstdint>
#include <memory>

#include "core/run/assembly/assembly.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/message/figures.hpp"
#include "core/run/place/place.hpp"
#include "transport/places/place_transport.hpp"
#include "transport/zmq/zmq_place_transport.hpp"

namespace lightnet {

/// N places in threads of this process, and the carrier with which the caller asks them. Used by one thread.
class ThreadedRun {
public:
    /// Returns when all places are ready. `make_transport`: of what carries messages between them.
    ThreadedRun(std::shared_ptr<const Network> network, std::uint64_t run, Plan plan, Tuning rules,
                const MakePlaceTransport& make_transport = zmq_within_process);
    ~ThreadedRun();

    Carrier& carrier();
    /// Throws Error when a place has died.
    void check();
    /// From now on, looks at what the places are at.
    void watch();
    HostFigures figures() const;
    /// Stops all places and returns what they counted.
    Counters stop();

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace lightnet
