// Counts of what went over a connection, by which a message is missed that was lost without a trace.
#pragma once

#include <cstdint>
#include <optional>

#include "transport/wire/packet.hpp"

namespace lightnet {

/// Messages that this end and the other have counted. What lies between their counts is the same on an undamaged
/// connection at each heartbeat.
class MessageCounts {
public:
    void received() { ++received_; }
    /// Of `sent` messages: how many have not arrived, as far as is known.
    std::uint64_t under_way(std::uint64_t sent) const { return sent - arrived_; }
    /// The other end has counted so many of those sent.
    void arrived(std::uint64_t sent) { arrived_ = sent; }
    /// By an answer to a heartbeat. `old_line`: something may still come on one that has a successor, which is counted
    /// by one end only.
    bool lacks_something(const packet::Fields& pong, bool old_line);
    /// Another connection: all that was `sent` counts as arrived.
    void restart(std::uint64_t sent) { between_.reset(), arrived_ = sent; }

private:
    struct Between {
        std::uint64_t line, asks, replies;
        friend bool operator==(const Between&, const Between&) = default;
    };
    std::uint64_t received_ = 0;
    std::uint64_t arrived_ = 0;  // of those sent, at least
    std::optional<Between> between_;
};

}  // namespace lightnet
