#include "transport/zmq/handshake_watch.hpp"

#include <zmq.h>
#include <atomic>
#include <cstdint>
#include <cstring>

namespace lightnet {
namespace {

constexpr int handshakes = ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                           ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;

Socket events_of(const SocketContext& context, Socket& socket) {
    const auto endpoint = fresh_events_endpoint();
    if (zmq_socket_monitor(socket.library(), endpoint.c_str(), handshakes) != 0) throw SocketError();
    Socket events(context, ZMQ_PAIR);
    events.connect(endpoint);
    return events;
}

}  // namespace

std::string fresh_events_endpoint() {
    static std::atomic<unsigned> number{0};
    return "inproc://socket-events-" + std::to_string(number++);
}

// An event is two frames: a number of 16 bits and a value of 32, then the address.
std::optional<SocketEvent> event_in(const Frames& frames) {
    std::uint16_t number = 0;
    std::int32_t value = 0;
    if (frames.front().size() < sizeof number + sizeof value) return std::nullopt;
    std::memcpy(&number, frames.front().data(), sizeof number);
    std::memcpy(&value, static_cast<const char*>(frames.front().data()) + sizeof number, sizeof value);
    return SocketEvent{number, value};
}

HandshakeWatch::HandshakeWatch(const SocketContext& context, Socket& socket) : events_(events_of(context, socket)) {}

std::optional<Handshake> HandshakeWatch::look() {
    std::optional<Handshake> last;
    while (const auto frames = events_.receive()) {
        const auto event = event_in(*frames);
        if (!event) continue;
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
