// The outcome of handshakes of a socket: ZeroMQ itself says nothing to who waits for an answer.
#pragma once

#include <chrono>
#include <optional>

#include "transport/zmq/socket.hpp"

namespace lightnet {

/// Has a socket that connects note how its handshakes end. Before it is connected.
void note_handshakes(const SocketContext& context, Socket& socket);
/// How the last one ended since the last call; none: there was none.
std::optional<Handshake> last_handshake(Socket& socket);
/// How the one ended of which an event tells; none: it tells of something else.
std::optional<Handshake> handshake_in(const SocketEvent& event);
/// Tells who says nothing from who hangs up. Of sockets that connect, one after the other.
class HandshakeWatch {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// As handshake_in().
    std::optional<Handshake> see(const SocketEvent& event, Time now);
    /// What is seen from now on is of another socket.
    void begin() { begun_.reset(); }

    std::optional<Handshake> last;  // of those that count: its owner's business

private:
    std::optional<Time> begun_;
};
/// The events of which it is told.
int handshake_events();

}  // namespace lightnet
