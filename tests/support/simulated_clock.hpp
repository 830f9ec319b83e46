// The clock of a program whose time is simulated: the system's steady clock, the thread's processor time and the
// counter by which fibers are measured, all in one.
#pragma once

#include <cstdint>

namespace lightnet::test {

/// While one lives, this process has no other time than what it is set to, and what work costs: so much each time when
/// a fiber begins, parks or is measured. For programs of one thread that link simulated_clock.cpp.
class SimulatedClock {
public:
    /// `seed`: of how long work takes.
    explicit SimulatedClock(std::uint64_t seed);
    ~SimulatedClock();
    SimulatedClock(const SimulatedClock&) = delete;
    SimulatedClock& operator=(const SimulatedClock&) = delete;

    double seconds() const;
    void set(double seconds);
    /// Work takes so many times as long from now on.
    void slow_down(double times);
};

}  // namespace lightnet::test
