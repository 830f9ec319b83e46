// Browsers for tests: what goes over the line, byte by byte.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "tests/support/slowdown.hpp"

namespace lightnet::test {

/// One connection. Nothing waits longer than `patience`.
class Visitor {
public:
    /// `receive_buffer`: of the system, bytes; 0: as it likes.
    explicit Visitor(std::uint16_t port, int receive_buffer = 0);
    ~Visitor();
    Visitor(const Visitor&) = delete;
    Visitor& operator=(const Visitor&) = delete;

    bool connected() const { return socket_ >= 0; }
    void send(std::string_view bytes) const;
    /// No more will be sent.
    void end() const;
    /// All that comes until the other side closes, or until nothing has come for so long.
    std::string all(std::chrono::milliseconds patience = slowdown * std::chrono::seconds(8));
    /// Says that it wants to watch; true: it may.
    bool watch(const std::string& host, const std::string& origin = "");
    /// The next message of a WebSocket. None: the line is closed, or `patience` passed.
    struct Frame {
        bool text = false;
        std::string data;
    };
    std::optional<Frame> next(std::chrono::milliseconds patience = slowdown * std::chrono::seconds(20));
    /// The next text that holds this.
    std::optional<std::string> next_with(const std::string& part);
    void say(std::string_view text) const;

private:
    bool more(std::chrono::milliseconds patience);
    bool have(std::size_t bytes, std::chrono::milliseconds patience);
    int socket_ = -1;
    std::string come_;
};

/// GET by this host name; the whole answer.
std::string get(std::uint16_t port, const std::string& target, const std::string& more = "",
                const std::string& host = "");
/// "HTTP/1.1 404 Not Found" → 404
int status_of(std::string_view answer);

}  // namespace lightnet::test
