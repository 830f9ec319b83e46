// The seam between the places of a process and what carries messages between them. Another transport is a folder beside
// zmq/, and a line where a run is started (see ThreadedRun).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "core/run/message/carrier.hpp"

namespace lightnet {

/// Carries messages between the places of one process in one run, and gives each its carrier. Outlives the places. One
/// thread's, but for carrier_of().
class PlaceTransport {
public:
    using AtFault = std::function<void(const Failure&)>;

    virtual ~PlaceTransport() = default;
    /// The carrier of a place, or of the dispatcher (any_place), made on its thread, and used by no other. From then on
    /// others may ask it. `at_fault` is told of hosts that failed.
    virtual std::unique_ptr<Carrier> carrier_of(std::uint32_t place, AtFault at_fault) = 0;
    /// A carrier that asks places and answers nobody, as the master does.
    virtual std::unique_ptr<Carrier> asking_carrier() = 0;
    /// Brings a place, or the dispatcher, a message to which there is no reply: a plan, or a stop. The place has its
    /// carrier by then.
    virtual void tell(std::uint32_t place, Message message) = 0;
};

/// Makes the transport of a run that stays within this process.
using MakePlaceTransport = std::function<std::unique_ptr<PlaceTransport>(std::uint64_t run, std::uint32_t places)>;

}  // namespace lightnet
