// The outcome of handshakes of a socket: ZeroMQ itself says nothing to who waits for an answer.
#pragma once

#include <optional>

#include "transport/zmq/socket.hpp"

namespace lightnet {

/// How a handshake ended.
enum class Handshake {
    made,        // they know each other
    refused,     // the other end doesn't take our key
    mismatched,  // one end speaks with keys, the other without; after this and after `refused` ZeroMQ tries no more
    abandoned    // by the other end, which may be mismatched, have another key, or be cut off
};

/// Has a socket that connects note how its handshakes end. Before it is connected.
void note_handshakes(const SocketContext& context, Socket& socket);
/// How the last one ended since the last call; none: there was none.
std::optional<Handshake> last_handshake(Socket& socket);
/// How the one ended of which an event tells; none: it tells of something else.
std::optional<Handshake> handshake_in(const SocketEvent& event);
/// The events of which it is told.
int handshake_events();

}  // namespace lightnet
