// The memory that the daemons of a supervisor may hold together.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lightnet {

/// What a process holds and has done. A value.
struct ProcessUse {
    std::uint64_t memory = 0;  // bytes that are its own, where swapped out as well
    std::chrono::milliseconds computed{};
};
/// None: it is gone.
std::optional<ProcessUse> use_of(int process);

/// Says which of some processes is to end when all together hold more than they may. Only those that hold more than an
/// equal part are to: others would give little back. Of them it is the one that has computed nothing for longest, and
/// of several at work the largest. Time is an argument.
/// DECISIONS: idle-longest-ends
class MemoryBound {
public:
    using Time = std::chrono::steady_clock::time_point;
    struct Verdict {
        std::size_t number = 0;
        std::uint64_t together = 0, its = 0;  // bytes
        std::chrono::seconds idle{};
    };
    explicit MemoryBound(std::uint64_t most) : most_(most) {}

    /// `all`: by number; none: there is no such process now, or it is about to end. To be called about once a second.
    std::optional<Verdict> look(const std::vector<std::optional<ProcessUse>>& all, Time now);

private:
    struct Seen {
        std::chrono::milliseconds computed{};
        Time at{}, worked{};
    };
    void note_work(const std::vector<std::optional<ProcessUse>>& all, Time now);

    std::uint64_t most_;
    std::vector<std::optional<Seen>> seen_;
};

}  // namespace lightnet
