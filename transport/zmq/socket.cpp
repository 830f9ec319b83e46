#include "transport/zmq/socket.hpp"

#include <zmq.h>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <utility>

#include "core/base/ip_address.hpp"
#include "core/base/spare_threads.hpp"
#include "transport/address/listening.hpp"
#include "transport/places/descriptors.hpp"

namespace lightnet {
namespace {

// ZeroMQ's own threads and what they wait at.
constexpr std::size_t descriptors_of_context = 16;
constexpr std::size_t threads_of_context = 1;  // that closes sockets
constexpr int most_sockets = 65535;            // that it can have

// Who is silent is noticed before by those who talk to him, as they know what is under way; this is for connections
// that nobody looks after, and a line may be busy for a while.
constexpr int heartbeat_ms = 500, heartbeat_timeout_ms = 3000, time_to_live_ms = 5000, handshake_ms = 4000;

void common_options(Socket& socket) {
    socket.set(ZMQ_SNDHWM, high_water_mark);
    socket.set(ZMQ_RCVHWM, high_water_mark);
    const auto most = static_cast<std::int64_t>(packet::most_bytes);
    if (zmq_setsockopt(socket.library(), ZMQ_MAXMSGSIZE, &most, sizeof most) != 0) throw SocketError();
    socket.set(ZMQ_HANDSHAKE_IVL, handshake_ms);
}

void heartbeat_options(Socket& socket) {
    socket.set(ZMQ_HEARTBEAT_IVL, heartbeat_ms);
    socket.set(ZMQ_HEARTBEAT_TIMEOUT, heartbeat_timeout_ms);
    socket.set(ZMQ_HEARTBEAT_TTL, time_to_live_ms);
}

IpAddress number_in(const std::string& endpoint) {
    const auto parts = tcp_endpoint(endpoint);
    const auto number = parts ? ip_address(parts->host) : std::nullopt;
    if (!number) throw SocketError(EINVAL);
    return *number;
}

std::uint16_t port_number(const std::string& port) {
    std::uint16_t number = 0;
    const auto [end, fault] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (fault != std::errc{} || end != port.data() + port.size()) throw SocketError(EINVAL);
    return number;
}

ListeningPort open_port(const IpAddress& address, std::uint16_t port) {
    try {
        return ListeningPort(address, port);
    } catch (const std::system_error& error) {
        throw SocketError(error.code().value());
    }
}

}  // namespace

SocketError::SocketError(int number) : std::runtime_error(zmq_strerror(number)), number_(number) {}
SocketError::SocketError() : SocketError(zmq_errno()) {}
bool SocketError::out_of_descriptors() const { return number_ == EMFILE || number_ == ENFILE; }

// DECISIONS: threads-are-tried
// The library starts its threads with the first socket, and ends the process when it gets none: they are asked for
// beforehand, and started at once, so that nobody else of this process takes them meanwhile.
SocketContext::SocketContext(int io_threads, std::shared_ptr<const NameService> names)
    : names_(std::make_unique<Resolver>(std::move(names))) {
    want_descriptors(descriptors_of_context, "a process with sockets");
    want_threads(static_cast<std::size_t>(io_threads) + threads_of_context, "a process with sockets");
    context_ = zmq_ctx_new();
    if (!context_) throw SocketError();
    zmq_ctx_set(context_, ZMQ_IO_THREADS, io_threads);
    zmq_ctx_set(context_, ZMQ_MAX_SOCKETS, most_sockets);
    if (void* const first = zmq_socket(context_, ZMQ_PAIR)) zmq_close(first);
}

SocketContext::~SocketContext() {
    while (zmq_ctx_term(context_) != 0 && zmq_errno() == EINTR) {
    }
}

Socket::Socket(const SocketContext& context, int type) : socket_(zmq_socket(context.library(), type)) {
    if (!socket_) throw SocketError();
    set(ZMQ_LINGER, 0);
}

// The library's own thread tells events, and waits for ever once nobody is there to take them: it must have stopped
// telling before the taker goes, and a socket that is closed can't be told to stop.
Socket::~Socket() {
    if (events_) zmq_socket_monitor(socket_, nullptr, 0);
    events_.reset();
    if (socket_) zmq_close(socket_);
}

Socket::Socket(Socket&& other) noexcept
    : socket_(std::exchange(other.socket_, nullptr)), quiet_(other.quiet_), events_(std::move(other.events_)) {}

Socket& Socket::operator=(Socket&& other) noexcept {
    std::swap(socket_, other.socket_);
    std::swap(quiet_, other.quiet_);
    std::swap(events_, other.events_);
    return *this;
}

void Socket::note_events(const SocketContext& context, int kinds) {
    static std::atomic<unsigned> number{0};
    const auto endpoint = "inproc://socket-events-" + std::to_string(number++);
    auto events = std::make_unique<Socket>(context, ZMQ_PAIR);
    events->set(ZMQ_RCVHWM, 0);  // who is slow to look must not hold up the library's thread
    if (zmq_socket_monitor(socket_, endpoint.c_str(), kinds) != 0) throw SocketError();
    events_ = std::move(events);
    events_->connect(endpoint);
}

// An event is two frames: a number of 16 bits and a value of 32, then the address.
std::optional<SocketEvent> Socket::next_event() {
    while (const auto frames = events_ ? events_->receive() : std::nullopt) {
        std::uint16_t number = 0;
        std::int32_t value = 0;
        const auto& event = frames->front();
        if (event.size() < sizeof number + sizeof value) continue;
        std::memcpy(&number, event.data(), sizeof number);
        std::memcpy(&value, static_cast<const char*>(event.data()) + sizeof number, sizeof value);
        return SocketEvent{number, value};
    }
    return std::nullopt;
}

void Socket::bind(const std::string& endpoint) {
    quiet_ = false;
    if (endpoint.starts_with("tcp://")) {
        const auto number = number_in(endpoint);
        const auto port = tcp_endpoint(endpoint)->port;
        return bind(open_port(number, port == "*" ? 0 : port_number(port)), endpoint);
    }
    if (zmq_bind(socket_, endpoint.c_str()) != 0) throw SocketError();
}

// The library itself would look at all network cards first, and end the process where it may not.
// DECISIONS: names-are-ours
void Socket::bind(ListeningPort port, const std::string& endpoint) {
    set(ZMQ_USE_FD, port.descriptor());
    if (zmq_bind(socket_, endpoint.c_str()) != 0) throw SocketError();
    port.give_away();
    set(ZMQ_USE_FD, -1);
}

void Socket::connect(const std::string& endpoint) {
    quiet_ = false;
    if (endpoint.starts_with("tcp://") && number_in(endpoint).six) set(ZMQ_IPV6, 1);
    if (zmq_connect(socket_, endpoint.c_str()) != 0) throw SocketError();
}

void Socket::unbind(const std::string& endpoint) noexcept {
    quiet_ = false;
    zmq_unbind(socket_, endpoint.c_str());
}

std::string Socket::endpoint() const {
    std::array<char, 1024> text{};
    std::size_t size = text.size();
    if (zmq_getsockopt(socket_, ZMQ_LAST_ENDPOINT, text.data(), &size) != 0) throw SocketError();
    return text.data();
}

// The library works off its descriptor here: from now on that tells nothing of what has come before.
int Socket::happenings() const {
    int events = 0;
    std::size_t size = sizeof events;
    if (zmq_getsockopt(socket_, ZMQ_EVENTS, &events, &size) != 0) throw SocketError();
    quiet_ = (events & ZMQ_POLLIN) == 0;
    return events;
}

bool Socket::readable() const { return (happenings() & ZMQ_POLLIN) != 0; }

bool Socket::can_send() const { return (happenings() & ZMQ_POLLOUT) != 0; }

int Socket::descriptor() const {
    int descriptor = 0;
    std::size_t size = sizeof descriptor;
    if (zmq_getsockopt(socket_, ZMQ_FD, &descriptor, &size) != 0) throw SocketError();
    return descriptor;
}

void Socket::set(int option, int value) {
    if (zmq_setsockopt(socket_, option, &value, sizeof value) != 0) throw SocketError();
}

void Socket::set(int option, const std::string& value) {
    if (zmq_setsockopt(socket_, option, value.data(), value.size()) != 0) throw SocketError();
}

void Socket::set_bytes(int option, const std::array<unsigned char, PublicKey::size>& bytes) {
    if (zmq_setsockopt(socket_, option, bytes.data(), bytes.size()) != 0) throw SocketError();
}

void Socket::call_with(const LineKeys& keys) {
    set_bytes(ZMQ_CURVE_PUBLICKEY, keys.own.open.bytes);
    set_bytes(ZMQ_CURVE_SECRETKEY, keys.own.secret);
    set_bytes(ZMQ_CURVE_SERVERKEY, keys.theirs.bytes);
}

void Socket::answer_with(const KeyPair& own) {
    set(ZMQ_CURVE_SERVER, 1);
    set_bytes(ZMQ_CURVE_SECRETKEY, own.secret);
}

SendResult Socket::try_send(Frames& frames) {
    happens_before_receiving();
    quiet_ = false;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const int more = i + 1 < frames.size() ? ZMQ_SNDMORE : 0;
        if (zmq_msg_send(frames[i].library(), socket_, more | ZMQ_DONTWAIT) >= 0) continue;
        const int error = zmq_errno();
        // only the first can be refused
        if (error == EHOSTUNREACH) return SendResult::peer_is_gone;
        if (error == EAGAIN || error == EINTR) return SendResult::line_is_full;
        throw SocketError(error);
    }
    return SendResult::sent;
}

std::optional<Frames> Socket::receive() {
    Frames frames;
    quiet_ = false;
    do {
        MessageFrame frame;
        if (zmq_msg_recv(frame.library(), socket_, ZMQ_DONTWAIT) < 0) {
            const int error = zmq_errno();
            quiet_ = error == EAGAIN;
            if (error == EAGAIN || error == EINTR || error == ETERM) return std::nullopt;
            throw SocketError(error);
        }
        frames.push_back(std::move(frame));
    } while (zmq_msg_more(frames.back().library()));
    happens_after_sending();
    return frames;
}

Socket answering_socket(const SocketContext& context) {
    Socket socket(context, ZMQ_ROUTER);
    common_options(socket);
    socket.set(ZMQ_ROUTER_MANDATORY, 1);
    return socket;
}

Socket door_socket(const SocketContext& context) {
    auto socket = answering_socket(context);
    socket.set(ZMQ_PROBE_ROUTER, 1);
    heartbeat_options(socket);
    socket.set(ZMQ_TCP_KEEPALIVE, 1);
    return socket;
}

Socket unconnected_asking_socket(const SocketContext& context, const std::string& endpoint,
                                 const std::optional<LineKeys>& keys) {
    Socket socket(context, ZMQ_DEALER);
    common_options(socket);
    socket.set(ZMQ_IMMEDIATE, 1);
    socket.set(ZMQ_RECONNECT_IVL, 50);
    socket.set(ZMQ_RECONNECT_IVL_MAX, 1000);
    if (!endpoint.starts_with("inproc://")) heartbeat_options(socket);  // a silent peer looks connected for ever
    if (keys) socket.call_with(*keys);
    return socket;
}

Socket asking_socket(const SocketContext& context, const std::string& endpoint, const std::optional<LineKeys>& keys) {
    auto socket = unconnected_asking_socket(context, endpoint, keys);
    socket.connect(endpoint);
    return socket;
}

}  // namespace lightnet
