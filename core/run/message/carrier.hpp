// The carrier of messages between places: the seam between the runtime and the transports.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/run/message/counters.hpp"
#include "core/run/message/message.hpp"

namespace lightnet {

/// One per place, used by its thread only. Nothing here blocks but wait(). Delivery is not promised: a message may be
/// lost with the place it was meant for, and only the reply tells that an ask has arrived.
class Carrier {
public:
    virtual ~Carrier() = default;
    /// Sends an ask. False: `to` can't take it now, and `message` is untouched.
    virtual bool ask(const PlaceAt& to, Message& message) = 0;
    /// Sends a reply or a failure along the route of the ask. A reply that can't be delivered is dropped.
    virtual void reply(Message message) = 0;
    /// What has arrived, if anything.
    virtual std::optional<Message> receive() = 0;
    /// Returns when something may have arrived, or after `most`.
    virtual void wait(std::chrono::nanoseconds most) = 0;
    /// Nobody waits any more for replies to what was asked on this channel.
    virtual void give_up(std::uint32_t /*channel*/) {}
    /// Brings bytes that an ask will name to a place, if need be. True when they are there; else ask again later.
    virtual bool bring(const PlaceAt&, const Hash&, const Bytes&) { return true; }
    /// From now on everybody asks by this plan. For carriers that propose plans.
    virtual void adopt(const Plan&) {}
    /// Work failed at `host` that others can do: from now on it gets none. False: that can't be, as there is
    /// nobody else, nor expected.
    virtual bool take_out(const std::string& /*host*/, const std::string& /*why*/) { return false; }
    /// May hosts that take no part yet still come? Until none will, failures at those that do are no reason to end.
    virtual bool expects_hosts() const { return false; }
    /// Somebody has answered falsely: all that he has said in this run is in doubt.
    virtual void doubt(const Failure& /*lie*/) {}
    /// A number that grows while places of `host` work, as far as is known; 0: it is not.
    virtual std::uint64_t pulse(const std::string& /*host*/) const { return 0; }
    /// Forgets about a place that is gone.
    virtual void forget(const PlaceAt& place) = 0;
    /// Where the carrier counts bytes and refusals.
    virtual const Counters& counters() const = 0;
};

}  // namespace lightnet
