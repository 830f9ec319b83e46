#include "transport/zmq/handshake.hpp"

#include <zmq.hpp>

namespace lightnet {

int handshake_events() {
    return ZMQ_EVENT_CONNECTED | ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
           ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;
}

void note_handshakes(const SocketContext& context, Socket& socket) { socket.note_events(context, handshake_events()); }

std::optional<Handshake> handshake_in(const SocketEvent& event) {
    switch (event.number) {
        case ZMQ_EVENT_HANDSHAKE_SUCCEEDED:
            return Handshake::made;
        case ZMQ_EVENT_HANDSHAKE_FAILED_AUTH:
            return Handshake::refused;
        case ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL:
            return Handshake::abandoned;
        case ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL:
            return event.value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH ? Handshake::mismatched
                                                                             : Handshake::abandoned;
        default:
            return std::nullopt;
    }
}

std::optional<Handshake> HandshakeWatch::see(const SocketEvent& event, Time now) {
    if (event.number == ZMQ_EVENT_CONNECTED) begun_ = now;
    const auto seen = handshake_in(event);
    // ZeroMQ's own patience is over; whoever hangs up does so at once. Events may be read late, but not by so much.
    const bool waited = begun_ && now - *begun_ > handshake_patience / 2;
    return seen == Handshake::abandoned && waited ? Handshake::unanswered : seen;
}

std::optional<Handshake> last_handshake(Socket& socket) {
    std::optional<Handshake> last;
    while (const auto event = socket.next_event())
        if (const auto seen = handshake_in(*event)) last = seen;
    return last;
}

}  // namespace lightnet
