#include "transport/zmq/socket.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <utility>
#include <zmq.hpp>

#include "core/base/ip_address.hpp"
#include "core/base/spare_threads.hpp"
#include "transport/address/listening.hpp"
#include "transport/places/descriptors.hpp"
#include "transport/zmq/process_id.hpp"

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void*);
extern "C" void __tsan_release(void*);
#endif

namespace lightnet {
namespace {

// ZeroMQ's own threads and what they wait at.
constexpr std::size_t descriptors_of_context = 16;
constexpr std::size_t threads_of_context = 1;  // that closes sockets
constexpr int most_sockets = 65535;            // that it can have

// Who is silent is noticed before by those who talk to him, as they know what is under way; this is for connections
// that nobody looks after, and a line may be busy for a while.
constexpr int heartbeat_ms = 500, heartbeat_timeout_ms = 3000, time_to_live_ms = 5000;

namespace option = zmq::sockopt;

// What the library throws would be the only one of its types outside this room.
template <class Work>
auto in_our_words(const Work& work) try {
    return work();
} catch (const zmq::error_t& error) {
    throw SocketError(error.num());
}

template <class Option, class Value>
void set(const Socket& socket, Option name, const Value& value) {
    in_our_words([&] { socket.library().set(name, value); });
}

void common_options(Socket& socket) {
    set(socket, option::sndhwm, high_water_mark);
    set(socket, option::rcvhwm, high_water_mark);
    set(socket, option::maxmsgsize, static_cast<std::int64_t>(packet::most_bytes));
    set(socket, option::handshake_ivl, static_cast<int>(handshake_patience.count()));
}

void heartbeat_options(Socket& socket) {
    set(socket, option::heartbeat_ivl, heartbeat_ms);
    set(socket, option::heartbeat_timeout, heartbeat_timeout_ms);
    set(socket, option::heartbeat_ttl, time_to_live_ms);
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

// Happens-before, told to the thread sanitizer, which can't see into the library: what a thread did before it sent a
// message is done when another receives it, or frees its memory.
#if defined(__SANITIZE_THREAD__)
char through_sockets;
void happens_before_receiving() { __tsan_release(&through_sockets); }
void happens_after_sending() { __tsan_acquire(&through_sockets); }
#else
void happens_before_receiving() {}
void happens_after_sending() {}
#endif

using Owner = std::shared_ptr<const void>;

void free_owner(void*, void* owner) {
    happens_after_sending();
    delete static_cast<Owner*>(owner);
}

// The library's message of a frame, without a copy where they are many bytes.
zmq::message_t message_of(const MessageFrame& frame) try {
    if (!frame.owner()) return zmq::message_t(frame.data(), frame.size());
    auto owner = std::make_unique<Owner>(frame.owner());
    zmq::message_t message(const_cast<void*>(frame.data()), frame.size(), free_owner, owner.get());
    (void)owner.release();
    return message;
} catch (const zmq::error_t&) {
    throw std::bad_alloc();
}

MessageFrame frame_of(zmq::message_t&& message) {
    if (message.size() <= MessageFrame::most_small) return MessageFrame(message.to_string_view());
    auto owner = std::make_shared<zmq::message_t>(std::move(message));
    auto* const data = owner->data();
    const auto size = owner->size();
    return {std::move(owner), data, size};
}

// A text that the library keeps with a message; not by cppzmq, which throws where there is none: that is usual, and
// asked for each message. Never inlined, as tests/tsan.supp names it.
[[gnu::noinline]] std::string text_of_message(zmq::message_t& message, const char* name) {
    const char* text = zmq_msg_gets(message.handle(), name);
    return text ? text : "";
}

}  // namespace

SocketError::SocketError(int number) : LineError(number, zmq_strerror(number)) {}

// DECISIONS: threads-are-tried
// The library starts its threads with the first socket, and ends the process when it gets none: they are asked for
// beforehand, and started at once, so that nobody else of this process takes them meanwhile.
SocketContext::SocketContext(int io_threads, std::shared_ptr<const NameService> names)
    : names_(std::make_unique<Resolver>(std::move(names))), awake_(io_threads) {
    keep_process_id();
    want_descriptors(descriptors_of_context, "a process with sockets");
    want_threads(static_cast<std::size_t>(io_threads) + threads_of_context, "a process with sockets");
    context_ = in_our_words([&] { return std::make_unique<zmq::context_t>(io_threads, most_sockets); });
    try {
        const zmq::socket_t first(*context_, zmq::socket_type::pair);
    } catch (const zmq::error_t&) {  // who needs one is told so
    }
}

SocketContext::~SocketContext() = default;

Socket::Socket(const SocketContext& context, int type)
    : socket_(in_our_words([&] { return std::make_unique<zmq::socket_t>(context.library(), type); })) {
    set(*this, option::linger, 0);
}

// The library's own thread tells events, and waits for ever once nobody is there to take them: it must have stopped
// telling before the taker goes, and a socket that is closed can't be told to stop.
Socket::~Socket() {
    if (events_) zmq_socket_monitor(socket_->handle(), nullptr, 0);
    events_.reset();
}

Socket::Socket(Socket&& other) noexcept = default;

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
    set(*events, option::rcvhwm, 0);  // who is slow to look must not hold up the library's thread
    if (zmq_socket_monitor(socket_->handle(), endpoint.c_str(), kinds) != 0) throw SocketError(zmq_errno());
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
    in_our_words([&] { socket_->bind(endpoint); });
}

// The library itself would look at all network cards first, and end the process where it may not.
// DECISIONS: names-are-ours
void Socket::bind(ListeningPort port, const std::string& endpoint) {
    set(*this, option::use_fd, port.descriptor());
    in_our_words([&] { socket_->bind(endpoint); });
    port.give_away();
    set(*this, option::use_fd, -1);
}

void Socket::connect(const std::string& endpoint) {
    quiet_ = false;
    if (endpoint.starts_with("tcp://") && number_in(endpoint).six) set(*this, option::ipv6, true);
    in_our_words([&] { socket_->connect(endpoint); });
}

void Socket::unbind(const std::string& endpoint) noexcept {
    quiet_ = false;
    zmq_unbind(socket_->handle(), endpoint.c_str());  // which it may not have been bound to
}

std::string Socket::endpoint() const {
    return in_our_words([&] { return socket_->get(option::last_endpoint); });
}

// The library works off its descriptor here: from now on that tells nothing of what has come before.
int Socket::happenings() const {
    const int events = in_our_words([&] { return socket_->get(option::events); });
    quiet_ = (events & ZMQ_POLLIN) == 0;
    return events;
}

bool Socket::readable() const { return (happenings() & ZMQ_POLLIN) != 0; }

bool Socket::can_send() const { return (happenings() & ZMQ_POLLOUT) != 0; }

int Socket::descriptor() const {
    return in_our_words([&] { return socket_->get(option::fd); });
}

void Socket::call_with(const LineKeys& keys) {
    set(*this, option::curve_publickey, zmq::buffer(keys.own.open.bytes));
    set(*this, option::curve_secretkey, zmq::buffer(keys.own.secret));
    set(*this, option::curve_serverkey, zmq::buffer(keys.theirs.bytes));
}

void Socket::answer_with(const KeyPair& own) {
    set(*this, option::curve_server, true);
    set(*this, option::curve_secretkey, zmq::buffer(own.secret));
}

SendResult Socket::try_send(Frames& frames) try {
    quiet_ = false;
    for (auto& frame : frames) {
        const auto more = &frame == &frames.back() ? zmq::send_flags::none : zmq::send_flags::sndmore;
        // only the first can be refused
        auto message = message_of(frame);
        happens_before_receiving();
        if (!socket_->send(message, more | zmq::send_flags::dontwait)) return SendResult::line_is_full;
        frame = MessageFrame();
    }
    return SendResult::sent;
} catch (const zmq::error_t& error) {
    if (error.num() == EHOSTUNREACH) return SendResult::peer_is_gone;
    if (error.num() == EINTR) return SendResult::line_is_full;
    throw SocketError(error.num());
}

std::optional<Frames> Socket::receive(PeerName* sender) try {
    Frames frames;
    quiet_ = false;
    for (bool more = true; more;) {
        zmq::message_t message;
        if (!socket_->recv(message, zmq::recv_flags::dontwait)) {
            quiet_ = true;
            return std::nullopt;
        }
        more = message.more();
        if (sender && !more) *sender = {text_of_message(message, "User-Id"), text_of_message(message, "Peer-Address")};
        frames.push_back(frame_of(std::move(message)));
    }
    happens_after_sending();
    return frames;
} catch (const zmq::error_t& error) {
    if (error.num() == EINTR || error.num() == ETERM) return std::nullopt;
    throw SocketError(error.num());
}

Socket answering_socket(const SocketContext& context) {
    Socket socket(context, ZMQ_ROUTER);
    common_options(socket);
    set(socket, option::router_mandatory, true);
    return socket;
}

Socket door_socket(const SocketContext& context) {
    auto socket = answering_socket(context);
    set(socket, option::probe_router, true);
    heartbeat_options(socket);
    set(socket, option::tcp_keepalive, 1);
    return socket;
}

Socket unconnected_asking_socket(const SocketContext& context, const std::string& endpoint,
                                 const std::optional<LineKeys>& keys) {
    Socket socket(context, ZMQ_DEALER);
    common_options(socket);
    set(socket, option::immediate, true);
    set(socket, option::reconnect_ivl, 50);
    set(socket, option::reconnect_ivl_max, 1000);
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
