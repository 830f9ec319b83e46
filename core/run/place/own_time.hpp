// The time that a place has had for itself.
#pragma once

#include <algorithm>
#include <chrono>

namespace lightnet {

/// A clock that stands still while other programs have the processor which a place could use: its thread's processor
/// time, and what it has slept because there was nothing to do. The place's thread looks at it; a look is a call of the
/// system.
class OwnTime {
public:
    using Nanoseconds = std::chrono::nanoseconds;

    /// Of the thread whose time it is.
    OwnTime();

    Nanoseconds now() const;
    /// It meant to sleep for `meant` at most, and was back after `took`: what is beyond, it waited for a processor.
    void slept(Nanoseconds meant, Nanoseconds took) {
        slept_ += std::min(meant, took);
        overslept_ += std::max(took - meant, Nanoseconds{0});
    }
    /// The part of so much time at work in which it was not ready to run while others had the processor; 1 where the
    /// system does not tell.
    double share_of(Nanoseconds at_work) const;

private:
    Nanoseconds slept_{0}, overslept_{0};
    Nanoseconds ready_before_;  // of its thread, when it began
};

}  // namespace lightnet
