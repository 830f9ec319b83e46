// Limits on waiting that count only time in which a process could go on.
#pragma once

#include <algorithm>
#include <chrono>

namespace lightnet {

/// How long something may still be waited for. While this process is stopped (by SIGSTOP, in a frozen container) nobody
/// waits: between two looks at most a second counts, so whoever waits looks more often than that. One thread's.
class Patience {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds between_looks{250};

    explicit Patience(Clock::duration most, Clock::time_point now = Clock::now()) : left_(most), looked_(now) {}

    bool is_over(Clock::time_point now = Clock::now()) {
        left_ -= std::min<Clock::duration>(now - looked_, std::chrono::seconds(1));
        looked_ = now;
        return left_ <= Clock::duration::zero();
    }
    /// Until the next look; 0 where it is over.
    std::chrono::milliseconds until_look() const {
        return std::clamp(std::chrono::ceil<std::chrono::milliseconds>(left_), std::chrono::milliseconds(0),
                          between_looks);
    }

private:
    Clock::duration left_;
    Clock::time_point looked_;
};

}  // namespace lightnet
