// A WebSocket that is called, and by which a program hears what a page would.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace lightnet {

/// One thread's.
class LiveLine {
public:
    /// `path`: "/live". Throws Error when nobody listens there within five seconds, or not for this.
    LiveLine(const std::string& host, std::uint16_t port, const std::string& path);
    ~LiveLine();
    LiveLine(const LiveLine&) = delete;
    LiveLine& operator=(const LiveLine&) = delete;

    /// The next message; none: nothing came for so long, or will ever.
    std::optional<std::string> next(std::chrono::milliseconds patience);
    /// The other end has closed, or is gone.
    bool is_over() const;
    /// Within five seconds, or it is over.
    void say(const std::string& text);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace lightnet
