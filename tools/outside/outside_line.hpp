// A line to the process that started this one, for functions that are answered there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lightnet {

/// A Unix socket. Each message is one byte that says what it is, the length of the rest as four bytes (the lowest
/// first), and the rest. One call at a time; not for several threads.
class OutsideLine {
public:
    /// Throws Error where nobody listens at `path`.
    explicit OutsideLine(const std::string& path);
    ~OutsideLine();
    OutsideLine(const OutsideLine&) = delete;
    OutsideLine& operator=(const OutsideLine&) = delete;

    struct Message {
        char kind = 0;
        std::vector<std::byte> data;
    };

    /// Throws Error when the other side is gone.
    void send(char kind, std::span<const std::byte> data);
    /// Waits for the next message, of `most` bytes at the most. Ends when this thread's work is no longer wanted.
    /// Throws Error when the other side is gone, or says more.
    Message hear(std::size_t most);

private:
    void read(std::span<std::byte> to);

    int socket_ = -1;
};

}  // namespace lightnet
