#include "transport/zmq/sockets.hpp"

#include <algorithm>
#include <memory>
#include <zmq.hpp>

#include "transport/places/descriptors.hpp"

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void*);
extern "C" void __tsan_release(void*);
#endif

namespace lightnet {
namespace {

// The sanitizer can't see into libzmq: what passes through a socket happens before it is received.
#if defined(__SANITIZE_THREAD__)
char through_zmq;
void before_send() { __tsan_release(&through_zmq); }
void after_receive() { __tsan_acquire(&through_zmq); }
#else
void before_send() {}
void after_receive() {}
#endif

void common_options(zmq::socket_t& socket) {
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::sndhwm, high_water_mark);
    socket.set(zmq::sockopt::rcvhwm, high_water_mark);
    socket.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(packet::most_bytes));
    socket.set(zmq::sockopt::handshake_ivl, 2000);
}

// ZeroMQ's own threads and what they wait at.
constexpr std::size_t descriptors_of_context = 16;
constexpr int most_sockets = 65535;  // that it can have

constexpr int heartbeat_ms = 500, heartbeat_timeout_ms = 1500, time_to_live_ms = 5000;

}  // namespace

std::unique_ptr<zmq::context_t> make_context(int io_threads) {
    want_descriptors(descriptors_of_context, "a process with sockets");
    auto context = std::make_unique<zmq::context_t>(io_threads);
    context->set(zmq::ctxopt::max_sockets, most_sockets);
    return context;
}

void poll(std::vector<zmq_pollitem_t>& items, std::chrono::milliseconds most) {
    if (zmq_poll(items.data(), static_cast<int>(items.size()), static_cast<long>(most.count())) < 0 &&
        zmq_errno() != EINTR)
        throw zmq::error_t();
}

zmq_pollitem_t readable(zmq::socket_t& socket) { return {socket.handle(), 0, ZMQ_POLLIN, 0}; }
zmq_pollitem_t readable(int descriptor) { return {nullptr, descriptor, ZMQ_POLLIN, 0}; }

zmq::socket_t answering_socket(zmq::context_t& context) {
    zmq::socket_t socket(context, zmq::socket_type::router);
    common_options(socket);
    socket.set(zmq::sockopt::router_mandatory, true);
    return socket;
}

zmq::socket_t door_socket(zmq::context_t& context) {
    auto socket = answering_socket(context);
    socket.set(zmq::sockopt::probe_router, true);
    socket.set(zmq::sockopt::heartbeat_ivl, heartbeat_ms);
    socket.set(zmq::sockopt::heartbeat_timeout, heartbeat_timeout_ms);
    socket.set(zmq::sockopt::heartbeat_ttl, time_to_live_ms);
    socket.set(zmq::sockopt::tcp_keepalive, 1);
    return socket;
}

zmq::socket_t asking_socket(zmq::context_t& context, const std::string& endpoint) {
    zmq::socket_t socket(context, zmq::socket_type::dealer);
    common_options(socket);
    socket.set(zmq::sockopt::immediate, true);
    socket.set(zmq::sockopt::reconnect_ivl, 50);
    socket.set(zmq::sockopt::reconnect_ivl_max, 1000);
    if (!endpoint.starts_with("inproc://")) {  // a peer that swallows what it gets looks connected for ever
        socket.set(zmq::sockopt::heartbeat_ivl, heartbeat_ms);
        socket.set(zmq::sockopt::heartbeat_timeout, heartbeat_timeout_ms);
        socket.set(zmq::sockopt::heartbeat_ttl, time_to_live_ms);
    }
    socket.connect(endpoint);
    return socket;
}

bool send_frames(zmq::socket_t& socket, Frames& frames) {
    before_send();
    try {
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const auto more = i + 1 < frames.size() ? zmq::send_flags::sndmore : zmq::send_flags::none;
            if (!socket.send(frames[i], more | zmq::send_flags::dontwait))
                return false;  // only the first can be refused
        }
    } catch (const zmq::error_t& error) {
        if (error.num() == EHOSTUNREACH || error.num() == EAGAIN || error.num() == EINTR) return false;
        throw;
    }
    return true;
}

std::optional<Frames> receive_frames(zmq::socket_t& socket) {
    Frames frames;
    try {
        do {
            zmq::message_t frame;
            if (!socket.recv(frame, zmq::recv_flags::dontwait)) return std::nullopt;
            frames.push_back(std::move(frame));
        } while (frames.back().more());
    } catch (const zmq::error_t& error) {
        if (error.num() == EINTR || error.num() == ETERM) return std::nullopt;
        throw;
    }
    after_receive();
    return frames;
}

bool is_empty(const Frames& frames) {
    return frames.size() <= 2 && std::all_of(frames.begin(), frames.end(), [](const auto& f) { return f.size() == 0; });
}

Frames empty_message() {
    Frames frames;
    frames.emplace_back();
    return frames;
}

zmq::message_t frame_of(const std::string& bytes) { return zmq::message_t(bytes.data(), bytes.size()); }

zmq::message_t frame_of(std::vector<std::byte>&& bytes) {
    auto owner = std::make_unique<std::vector<std::byte>>(std::move(bytes));
    zmq::message_t frame(
        owner->data(), owner->size(),
        [](void*, void* hint) {
            after_receive();
            delete static_cast<std::vector<std::byte>*>(hint);
        },
        owner.get());
    (void)owner.release();
    return frame;
}

zmq::message_t frame_of(Message&& message) {
    auto owner = std::make_unique<Message>(std::move(message));
    zmq::message_t frame(
        owner.get(), sizeof(Message),
        [](void* data, void*) {
            after_receive();
            delete static_cast<Message*>(data);
        },
        nullptr);
    (void)owner.release();
    return frame;
}

Message take_message(zmq::message_t& frame) { return std::move(*static_cast<Message*>(frame.data())); }

void append(Frames& frames, packet::Packet packet) {
    frames.push_back(frame_of(std::move(packet.header)));
    frames.push_back(frame_of(std::move(packet.body)));
}

std::span<const std::byte> bytes_of(const zmq::message_t& frame) {
    return {static_cast<const std::byte*>(frame.data()), frame.size()};
}

std::string text_of(const zmq::message_t& frame) { return {static_cast<const char*>(frame.data()), frame.size()}; }

}  // namespace lightnet
