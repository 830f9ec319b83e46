// Time that passes, and a periodic timer for work that takes time itself.
#pragma once

#include <algorithm>
#include <chrono>

namespace lightnet {

/// Seconds from then until now.
inline double seconds_since(std::chrono::steady_clock::time_point then) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

/// Once every period, or more seldom where it takes long.
class Pace {
public:
    using Clock = std::chrono::steady_clock;

    Pace(std::chrono::duration<double> period, Clock::time_point now) : period_(of_a_clock(period)) { put_off(now); }

    bool due(Clock::time_point now) const { return now >= next_; }
    /// By a period from now, and by `pause` at least.
    void put_off(Clock::time_point now, std::chrono::duration<double> pause = {}) {
        next_ = now + std::max(period_, of_a_clock(pause));
    }
    /// As a clock counts it, which goes no further than some hundred years.
    static Clock::duration of_a_clock(std::chrono::duration<double> time) {
        constexpr std::chrono::duration<double> longest(1e9);
        return std::chrono::ceil<Clock::duration>(std::min(time, longest));
    }

private:
    Clock::duration period_;
    Clock::time_point next_;
};

}  // namespace lightnet
