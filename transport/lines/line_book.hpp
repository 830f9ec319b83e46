// The hosts of a run that places may call by themselves.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "transport/keys/key.hpp"

namespace lightnet {

/// Which hosts places may call over lines of their own, rather than by way of the one line that their host has to each:
/// written by the thread that has those lines, and read by places. Any thread.
/// DECISIONS: own-lines-to-few-hosts
class LineBook {
public:
    struct Entry {
        std::string endpoint;            // in numbers
        std::optional<LineKeys> keys{};  // none: nothing is encrypted
        std::uint64_t line = 0;          // of the host's own one: another number, and all are to be renewed
        std::size_t room = 0;            // bytes that may be under way on the line of each place
        bool same_line(const Entry& other) const { return endpoint == other.endpoint && line == other.line; }
        friend bool operator==(const Entry& a, const Entry& b) { return a.same_line(b) && a.room == b.room; }
    };
    using Entries = std::map<std::string, Entry>;  // by host, as in plans

    void use(Entries entries);
    /// Another number: something has changed since.
    std::uint64_t edition() const { return edition_.load(std::memory_order_acquire); }
    Entries entries() const;

private:
    mutable std::mutex mutex_;
    Entries entries_;
    std::atomic<std::uint64_t> edition_{0};
};

}  // namespace lightnet
