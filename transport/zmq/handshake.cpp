#include "transport/zmq/handshake.hpp"

#include <zmq.h>

namespace lightnet {

void note_handshakes(const SocketContext& context, Socket& socket) {
    socket.note_events(context, ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                                    ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH);
}

std::optional<Handshake> last_handshake(Socket& socket) {
    std::optional<Handshake> last;
    while (const auto event = socket.next_event()) {
        if (event->number == ZMQ_EVENT_HANDSHAKE_SUCCEEDED) last = Handshake::made;
        if (event->number == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH) last = Handshake::refused;
        if (event->number == ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL) last = Handshake::abandoned;
        if (event->number == ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL)
            last = event->value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH ? Handshake::mismatched
                                                                              : Handshake::abandoned;
    }
    return last;
}

}  // namespace lightnet
