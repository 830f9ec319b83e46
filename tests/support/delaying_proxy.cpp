#include "tests/support/delaying_proxy.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <deque>
#include <list>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace lightnet::test {
namespace {

using Clock = std::chrono::steady_clock;

sockaddr_in loopback(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

/// Owns a socket.
class Socket {
public:
    explicit Socket(int handle) : handle_(handle) {
        const int one = 1;
        setsockopt(handle_, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    }
    Socket(Socket&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
    Socket& operator=(Socket&&) = delete;
    ~Socket() {
        if (handle_ >= 0) close(handle_);
    }
    int handle() const { return handle_; }

private:
    int handle_;
};

/// One direction of a connection.
struct Way {
    struct Chunk {
        Clock::time_point due;
        std::vector<char> bytes;
        std::size_t sent = 0;
    };
    int from, to;
    std::deque<Chunk> under_way;

    // False: the sender is gone.
    bool take(Clock::time_point due) {
        std::array<char, 65536> buffer;
        const auto size = recv(from, buffer.data(), buffer.size(), MSG_DONTWAIT);
        if (size > 0) under_way.push_back({due, {buffer.begin(), buffer.begin() + size}, 0});
        return size > 0 || (size < 0 && (errno == EAGAIN || errno == EINTR));
    }
    // False: the receiver is gone.
    bool pass_on(Clock::time_point now, std::atomic<std::uint64_t>& count, std::string* heard) {
        while (!under_way.empty() && under_way.front().due <= now) {
            auto& chunk = under_way.front();
            const auto size =
                send(to, chunk.bytes.data() + chunk.sent, chunk.bytes.size() - chunk.sent, MSG_DONTWAIT | MSG_NOSIGNAL);
            if (size < 0) return errno == EAGAIN || errno == EINTR;
            count += static_cast<std::uint64_t>(size);
            if (heard) heard->append(chunk.bytes.data() + chunk.sent, static_cast<std::size_t>(size));
            chunk.sent += static_cast<std::size_t>(size);
            if (chunk.sent < chunk.bytes.size()) return true;
            under_way.pop_front();
        }
        return true;
    }
};

struct Connection {
    Socket near, far;
    std::array<Way, 2> ways{Way{near.handle(), far.handle(), {}}, Way{far.handle(), near.handle(), {}}};
};

std::optional<Clock::time_point> next_due(const std::list<Connection>& connections) {
    std::optional<Clock::time_point> next;
    for (const auto& connection : connections)
        for (const auto& way : connection.ways)
            if (!way.under_way.empty()) next = std::min(next.value_or(Clock::time_point::max()), way.under_way[0].due);
    return next;
}

void wait(int listener, const std::list<Connection>& connections) {
    std::vector<pollfd> polled{{listener, POLLIN, 0}};
    for (const auto& connection : connections)
        for (const auto& way : connection.ways) polled.push_back({way.from, POLLIN, 0});
    auto most = std::chrono::nanoseconds(std::chrono::milliseconds(50));
    if (const auto due = next_due(connections)) most = std::min(most, std::chrono::nanoseconds(*due - Clock::now()));
    const timespec time{0, std::max<long>(0, most.count())};
    ppoll(polled.data(), polled.size(), &time, nullptr);
}

}  // namespace

DelayingProxy::DelayingProxy(const std::string& to, std::chrono::microseconds delay, const LineLoss& loss)
    : delay_(delay),
      loss_(loss),
      random_(loss.seed),
      to_(static_cast<std::uint16_t>(std::stoi(to.substr(to.rfind(':') + 1)))) {
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    auto address = loopback(0);
    socklen_t size = sizeof address;
    if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 || ::listen(listener_, 64) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        throw std::runtime_error("can't listen on loopback");
    port_ = ntohs(address.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

DelayingProxy::~DelayingProxy() {
    thread_.request_stop();
    thread_.join();
    close(listener_);
}

std::string DelayingProxy::endpoint() const { return "tcp://127.0.0.1:" + std::to_string(port_); }

bool DelayingProxy::has_heard(const std::string& text) const {
    const std::lock_guard lock(heard_mutex_);
    return heard_.find(text) != std::string::npos;
}

bool DelayingProxy::lose_one() {
    const bool lost = std::uniform_real_distribution<>()(random_) < loss_.share;
    losses_ += lost;
    return lost;
}

void DelayingProxy::serve(const std::stop_token& stop) {
    std::list<Connection> connections;
    while (!stop.stop_requested()) {
        wait(listener_, connections);
        const auto now = Clock::now();
        const std::lock_guard lock(heard_mutex_);
        for (auto at = connections.begin(); at != connections.end();) {
            bool alive = true;
            for (auto& way : at->ways) {
                const auto before = way.under_way.size();
                alive = alive && way.take(now + delay_);
                if (way.under_way.size() > before && lose_one()) way.under_way.back().due += loss_.delay;
                alive = alive && way.pass_on(now, bytes_, listens_ ? &heard_ : nullptr);
            }
            at = alive ? std::next(at) : connections.erase(at);
        }
        const int came = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        if (came < 0) continue;
        Socket near(came), far(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
        const auto address = loopback(to_);
        if (connect(far.handle(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
            connections.push_back({std::move(near), std::move(far)});
    }
}

}  // namespace lightnet::test
