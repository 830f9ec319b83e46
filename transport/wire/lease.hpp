// The time for which the other end of a line may be silent.
#pragma once

#include <chrono>

namespace lightnet {

/// Who is heard at intervals counts as there until he is silent for too long: `shortest`, and longer where his signs of
/// life come late, as those of a machine do that has more to do than it can. What was late once is kept in mind for
/// half a minute. A pure state machine: time is an argument.
/// DECISIONS: late-is-not-lost
class Lease {
public:
    using Time = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::steady_clock::duration;

    /// Signs of life are asked for so often.
    Lease(Duration interval, Duration shortest, Duration longest)
        : interval_(interval), shortest_(shortest), longest_(longest) {}

    /// Begins anew: nothing is known of how late he may be.
    void begin(Time now);
    /// A sign of life.
    void heard(Time now);
    Time last_heard() const { return heard_; }
    Duration length() const;
    /// `more`: the line is busy for so long with what was sent before.
    bool is_over(Time now, Duration more = {}) const { return now - heard_ > length() + more; }

private:
    Duration interval_, shortest_, longest_;
    Time heard_{}, late_at_{};
    Duration late_{};  // the latest sign of life, beyond the interval
};

}  // namespace lightnet
