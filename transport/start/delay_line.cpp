#include "transport/start/delay_line.hpp"

#include <array>
#include <deque>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio.hpp>

#include "core/base/error.hpp"
#include "core/base/ip_address.hpp"

namespace lightnet {
namespace {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using Fault = boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::size_t most_under_way = 64 << 20;  // bytes: who sends more has to wait, as on any line

/// The two ends of a connection that is passed on.
struct Ends {
    Tcp::socket caller, called;
    void close() {
        Fault ignored;
        caller.close(ignored);
        called.close(ignored);
    }
};

/// One of its two directions. Lives as long as something is under way.
class Direction : public std::enable_shared_from_this<Direction> {
public:
    Direction(std::shared_ptr<Ends> ends, Tcp::socket& from, Tcp::socket& to, std::chrono::milliseconds delay)
        : ends_(std::move(ends)), from_(from), to_(to), delay_(delay), timer_(from.get_executor()) {}

    void read() {
        reading_ = true;
        from_.async_read_some(asio::buffer(buffer_), [self = shared_from_this()](Fault fault, std::size_t size) {
            self->reading_ = false;
            self->came(fault ? 0 : size);
        });
    }

private:
    struct Bytes {
        Clock::time_point due;
        std::vector<char> bytes;  // none: the sender has ended
    };

    void came(std::size_t size) {
        waiting_.push_back({Clock::now() + delay_, {buffer_.begin(), buffer_.begin() + static_cast<long>(size)}});
        under_way_ += size;
        if (waiting_.size() == 1) wait_for_first();
        ended_ |= size == 0;
        read_on();
    }

    void read_on() {
        if (!ended_ && !reading_ && under_way_ < most_under_way) read();
    }

    void wait_for_first() {
        timer_.expires_at(waiting_.front().due);
        timer_.async_wait([self = shared_from_this()](Fault fault) {
            if (!fault) self->write_first();
        });
    }

    void write_first() {
        if (waiting_.front().bytes.empty()) return ends_->close();
        asio::async_write(to_, asio::buffer(waiting_.front().bytes),
                          [self = shared_from_this()](Fault fault, std::size_t size) {
                              if (fault) return self->ends_->close();
                              self->under_way_ -= size;
                              self->waiting_.pop_front();
                              if (!self->waiting_.empty()) self->wait_for_first();
                              self->read_on();
                          });
    }

    std::shared_ptr<Ends> ends_;
    Tcp::socket &from_, &to_;
    std::chrono::milliseconds delay_;
    asio::steady_timer timer_;
    std::array<char, 1 << 16> buffer_{};
    std::deque<Bytes> waiting_;
    std::size_t under_way_ = 0;
    bool reading_ = false, ended_ = false;
};

Tcp::endpoint address_in(const std::string& endpoint) {
    const auto parts = tcp_endpoint(endpoint);
    if (!parts || !ip_address(parts->host)) throw Error(endpoint, "is no address in numbers");
    return {asio::ip::make_address(parts->host), static_cast<unsigned short>(std::stoi(parts->port))};
}

}  // namespace

/// Waits for callers, in a thread of its own.
class DelayLine::Relay {
public:
    Relay(const std::string& endpoint, std::chrono::milliseconds delay)
        : to_(address_in(endpoint)), delay_(delay), door_(context_, {asio::ip::address_v4::loopback(), 0}) {
        accept();
        thread_ = std::thread([this] { context_.run(); });
    }
    ~Relay() {
        context_.stop();
        thread_.join();
    }

    std::string endpoint() const { return "tcp://127.0.0.1:" + std::to_string(door_.local_endpoint().port()); }

private:
    void accept() {
        door_.async_accept([this](Fault fault, Tcp::socket caller) {
            if (!fault) pass_on(std::move(caller));
            accept();
        });
    }

    void pass_on(Tcp::socket caller) {
        const auto ends = std::make_shared<Ends>(Ends{std::move(caller), Tcp::socket(context_)});
        ends->called.async_connect(to_, [ends, delay = delay_](Fault fault) {
            if (fault) return ends->close();
            Fault ignored;
            ends->caller.set_option(Tcp::no_delay(true), ignored);
            ends->called.set_option(Tcp::no_delay(true), ignored);
            std::make_shared<Direction>(ends, ends->caller, ends->called, delay)->read();
            std::make_shared<Direction>(ends, ends->called, ends->caller, delay)->read();
        });
    }

    Tcp::endpoint to_;
    std::chrono::milliseconds delay_;
    asio::io_context context_{1};
    Tcp::acceptor door_;
    std::thread thread_;
};

DelayLine::DelayLine(const std::string& endpoint, std::chrono::milliseconds delay) try
    : relay_(std::make_unique<Relay>(endpoint, delay)), endpoint_(relay_->endpoint()) {
} catch (const boost::system::system_error& error) {
    throw Error("no line that delays what goes to " + endpoint, error.what());
}

DelayLine::~DelayLine() = default;

}  // namespace lightnet
