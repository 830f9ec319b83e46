// What becomes of the handshakes of a socket: ZeroMQ itself says nothing to who waits for an answer.
#pragma once

#include <optional>

#include "transport/zmq/poll.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// How a handshake ended.
enum class Handshake {
    made,        // they know each other
    refused,     // the other end doesn't take our key
    mismatched,  // one end speaks with keys, the other without; after this and after `refused` ZeroMQ tries no more
    abandoned    // by the other end, which may be mismatched, have another key, or be cut off
};

/// Watches one socket that connects. One thread's, that of the socket.
class HandshakeWatch {
public:
    /// Before the socket is connected, which outlives it.
    HandshakeWatch(const SocketContext& context, Socket& socket);
    HandshakeWatch(HandshakeWatch&&) noexcept = default;
    HandshakeWatch& operator=(HandshakeWatch&&) noexcept = default;

    /// The last one since the last call; none: there was none.
    std::optional<Handshake> look();
    void watch(Poll& poll) const { poll.add(events_); }

private:
    Socket events_;
};

/// A name for a monitor's socket that no other has.
std::string fresh_events_endpoint();

/// The number of an event of the library, and its value. None: it is no event.
struct SocketEvent {
    int number = 0, value = 0;
};
std::optional<SocketEvent> event_in(const Frames& frames);

}  // namespace lightnet
