#include "tests/support/bad_line.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace lightnet::test {
namespace {

sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

bool write_all(int file, const char* bytes, std::size_t size) {
    while (size > 0) {
        const auto written = ::send(file, bytes, size, MSG_NOSIGNAL);
        if (written <= 0) return false;
        bytes += written;
        size -= static_cast<std::size_t>(written);
    }
    return true;
}

}  // namespace

BadLine::BadLine(const std::string& target) : target_port_(std::stoi(target.substr(target.rfind(':') + 1))) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    auto address = loopback(0);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_, 64) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        throw std::runtime_error("no port for a bad line");
    port_ = ntohs(address.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

BadLine::~BadLine() {
    thread_.request_stop();
    thread_.join();
    for (const auto& connection : connections_) reset(connection);
    ::close(listener_);
}

std::string BadLine::endpoint() const { return "tcp://127.0.0.1:" + std::to_string(port_); }

void BadLine::serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        if (cut_.exchange(false)) {
            for (const auto& connection : connections_) reset(connection);
            connections_.clear();
        }
        if (held_) {
            ::poll(nullptr, 0, 5);
            continue;
        }
        std::vector<pollfd> items{{listener_, POLLIN, 0}};
        for (const auto& connection : connections_)
            for (std::size_t from = 0; from < 2; ++from)
                items.push_back({held_ways_[from] ? -1 : connection.ends[from], POLLIN, 0});
        ::poll(items.data(), items.size(), 5);
        std::size_t item = 1;
        for (auto connection = connections_.begin(); connection != connections_.end();) {
            bool good = true;
            for (int from = 0; from < 2; ++from, ++item)
                if (good && items[item].revents) good = pass(*connection, from);
            if (!good) reset(*connection);
            connection = good ? std::next(connection) : connections_.erase(connection);
        }
        if (items[0].revents & POLLIN) accept_one();
    }
}

void BadLine::accept_one() {
    const int here = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    const int there = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const auto address = loopback(target_port_);
    const int on = 1;
    connections_.push_back({{here, there}});
    if (::connect(there, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        reset(connections_.back());
        connections_.pop_back();
        return;
    }
    for (const int end : {here, there}) ::setsockopt(end, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

bool BadLine::pass(Connection& connection, int from) {
    std::array<char, 65536> bytes;
    const auto got = ::recv(connection.ends[from], bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got <= 0) return false;
    auto size = static_cast<std::size_t>(got);
    const auto every = flip_every_.load();
    passed_ += size;
    if (every && passed_ >= every) {
        passed_ = 0;
        ++flips_;
        bytes[size / 2] = static_cast<char>(bytes[size / 2] ^ (1 << (flips_ % 8)));
    }
    wait_for(size);
    const bool truncated = size > 1 && truncate_.exchange(false);
    if (truncated) size /= 2;
    return write_all(connection.ends[1 - from], bytes.data(), size) && !truncated;
}

// Time that was overslept is made good.
void BadLine::wait_for(std::size_t bytes) {
    const double limit = limit_;
    if (limit <= 0) return;
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> takes(double(bytes) / limit);
    free_at_ = std::max(free_at_, now - std::chrono::milliseconds(2)) +
               std::chrono::duration_cast<std::chrono::nanoseconds>(takes);
    std::this_thread::sleep_until(free_at_);
}

void BadLine::reset(const Connection& connection) {
    const linger at_once{1, 0};
    for (const int end : connection.ends) {
        ::setsockopt(end, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
        ::close(end);
    }
    ++cuts_;
}

}  // namespace lightnet::test
