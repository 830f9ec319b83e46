#include "transport/start/latency_proxy.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <iterator>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/ip_address.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_under_way = 64 << 20;  // bytes: who sends more has to wait, as on any line
constexpr std::size_t most_at_once = 1 << 16;     // bytes read by one call

int checked(int result) {
    if (result < 0) throw std::system_error(errno, std::generic_category());
    return result;
}

/// A descriptor, closed with this object.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    operator int() const { return number_; }

private:
    int number_;
};

struct SystemAddress {
    sockaddr_storage bytes{};
    socklen_t size = sizeof bytes;
    sockaddr* get() { return reinterpret_cast<sockaddr*>(&bytes); }
};

SystemAddress address_in(const std::string& endpoint) {
    const auto parts = tcp_endpoint(endpoint);
    addrinfo wanted{}, *found = nullptr;
    wanted.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
    wanted.ai_socktype = SOCK_STREAM;
    if (!parts || getaddrinfo(parts->host.c_str(), parts->port.c_str(), &wanted, &found) != 0)
        throw Error(endpoint, "is no address in numbers");
    SystemAddress address;
    std::memcpy(&address.bytes, found->ai_addr, address.size = found->ai_addrlen);
    freeaddrinfo(found);
    return address;
}

Descriptor tcp_socket(int family) {
    return Descriptor(checked(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, IPPROTO_TCP)));
}

bool would_block() { return errno == EAGAIN || errno == EINTR; }

/// Bytes on their way from one end to the other.
class Direction {
public:
    Direction(int from, int to, std::chrono::milliseconds delay) : from_(from), to_(to), delay_(delay) {}

    bool wants_to_read() const { return !ended_ && under_way_ < most_under_way; }
    /// When it has something to send; none: nothing is under way.
    std::optional<Clock::time_point> due() const {
        return waiting_.empty() ? std::nullopt : std::optional(waiting_.front().due);
    }
    void read() {
        std::vector<char> bytes(most_at_once);
        const auto size = ::recv(from_, bytes.data(), bytes.size(), 0);
        if (size < 0 && would_block()) return;
        ended_ = size <= 0;
        bytes.resize(ended_ ? 0 : static_cast<std::size_t>(size));
        under_way_ += bytes.size();
        waiting_.push_back({Clock::now() + delay_, std::move(bytes)});
    }
    /// Sends what is due. False: the line is over.
    bool write(Clock::time_point now) {
        while (!waiting_.empty() && waiting_.front().due <= now) {
            const auto& bytes = waiting_.front().bytes;
            if (bytes.empty()) return false;
            const auto size = ::send(to_, bytes.data() + sent_, bytes.size() - sent_, MSG_NOSIGNAL);
            if (size < 0) return would_block();
            sent_ += static_cast<std::size_t>(size);
            if (sent_ < bytes.size()) return true;
            under_way_ -= std::exchange(sent_, 0);
            waiting_.pop_front();
        }
        return true;
    }

private:
    struct Bytes {
        Clock::time_point due;
        std::vector<char> bytes;  // none: the sender has ended
    };
    int from_, to_;
    std::chrono::milliseconds delay_;
    std::deque<Bytes> waiting_;
    std::size_t under_way_ = 0, sent_ = 0;  // bytes; sent: of the first
    bool ended_ = false;
};

/// A connection that is passed on.
class PassedOn {
public:
    PassedOn(Descriptor caller, Descriptor called, std::chrono::milliseconds delay)
        : caller_(std::move(caller)),
          called_(std::move(called)),
          there_(caller_, called_, delay),
          back_(called_, caller_, delay) {
        const int on = 1;
        for (const int end : {int(caller_), int(called_)}) setsockopt(end, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    }

    /// Two of them: what its ends wait for.
    void wait_for(std::vector<pollfd>& all, Clock::time_point now) const {
        all.push_back(waited_for(caller_, events(there_, back_, now)));
        all.push_back(waited_for(called_, connected_ ? events(back_, there_, now) : short{POLLOUT}));
    }
    /// The first time at which something is due that is not so yet.
    Clock::time_point due(Clock::time_point now, Clock::time_point latest) const {
        for (const auto* direction : {&there_, &back_})
            if (const auto due = direction->due(); due && *due > now) latest = std::min(latest, *due);
        return latest;
    }
    /// After these two have been waited for. False: it is over.
    bool go_on(const pollfd* ends, Clock::time_point now) {
        if (!connected_) {
            if (ends[1].revents == 0) return true;
            int fault = 0;
            socklen_t size = sizeof fault;
            if (getsockopt(called_, SOL_SOCKET, SO_ERROR, &fault, &size) != 0 || fault != 0) return false;
            connected_ = true;
            return true;
        }
        if (is_readable(ends[0], there_)) there_.read();
        if (is_readable(ends[1], back_)) back_.read();
        return there_.write(now) && back_.write(now);
    }

private:
    // An end of which nothing is wanted tells nothing: that it has ended it would tell for ever.
    static pollfd waited_for(int end, short events) { return {events != 0 ? end : -1, events, 0}; }
    static bool is_readable(const pollfd& end, const Direction& from) {
        return (end.revents & ~POLLOUT) != 0 && from.wants_to_read();
    }
    short events(const Direction& from, const Direction& to, Clock::time_point now) const {
        const bool reads = connected_ && from.wants_to_read(), writes = to.due() && *to.due() <= now;
        return static_cast<short>((reads ? POLLIN : 0) | (writes ? POLLOUT : 0));
    }

    Descriptor caller_, called_;
    Direction there_, back_;
    bool connected_ = false;
};

}  // namespace

/// Waits for callers, in a thread of its own.
class LatencyProxy::Relay {
public:
    Relay(const std::string& endpoint, std::chrono::milliseconds delay)
        : to_(address_in(endpoint)),
          delay_(delay),
          door_(tcp_socket(AF_INET)),
          end_(checked(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))) {
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        checked(::bind(door_, reinterpret_cast<const sockaddr*>(&at), sizeof at));
        checked(::listen(door_, SOMAXCONN));
        thread_ = std::thread([this] { work(); });
    }
    ~Relay() {
        eventfd_write(end_, 1);
        thread_.join();
    }

    std::string endpoint() const {
        sockaddr_in at{};
        socklen_t size = sizeof at;
        checked(::getsockname(door_, reinterpret_cast<sockaddr*>(&at), &size));
        return "tcp://127.0.0.1:" + std::to_string(ntohs(at.sin_port));
    }

private:
    void work() {
        std::vector<pollfd> all;
        for (;;) {
            const auto begun = Clock::now();
            auto latest = begun + std::chrono::hours(1);
            all = {{end_, POLLIN, 0}, {door_, POLLIN, 0}};
            for (const auto& line : lines_) line.wait_for(all, begun), latest = line.due(begun, latest);
            const auto patience = std::chrono::ceil<std::chrono::milliseconds>(latest - begun);
            if (::poll(all.data(), all.size(), static_cast<int>(patience.count())) < 0) continue;
            if (all[0].revents != 0) return;
            const pollfd* ends = all.data() + 2;
            const auto now = Clock::now();
            for (auto line = lines_.begin(); line != lines_.end(); ends += 2)
                line = line->go_on(ends, now) ? std::next(line) : lines_.erase(line);
            if (all[1].revents != 0) accept();
        }
    }

    void accept() try {
        const int number = ::accept4(door_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (number < 0) return;
        Descriptor caller(number), called = tcp_socket(to_.bytes.ss_family);
        if (::connect(called, to_.get(), to_.size) < 0 && errno != EINPROGRESS) return;
        lines_.emplace_back(std::move(caller), std::move(called), delay_);
    } catch (const std::system_error&) {  // out of descriptors: the caller is hung up on
    }

    SystemAddress to_;
    std::chrono::milliseconds delay_;
    Descriptor door_, end_;
    std::deque<PassedOn> lines_;
    std::thread thread_;
};

LatencyProxy::LatencyProxy(const std::string& endpoint, std::chrono::milliseconds delay) try
    : relay_(std::make_unique<Relay>(endpoint, delay)), endpoint_(relay_->endpoint()) {
} catch (const std::system_error& error) {
    throw Error("no line that delays what goes to " + endpoint, error.what());
}

LatencyProxy::~LatencyProxy() = default;

}  // namespace lightnet
