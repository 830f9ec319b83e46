// The number of samples for which there is time.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/support/pace.hpp"

namespace lightnet {

/// A time by which a run is to end, and what can be done until then. Time is an argument.
class TimeLimit {
public:
    using Time = Pace::Clock::time_point;

    /// None.
    TimeLimit() = default;
    TimeLimit(std::chrono::duration<double> most, Time begun) : end_(begun + Pace::of_a_clock(most)) {}

    explicit operator bool() const { return end_.has_value(); }
    std::optional<Time> end() const { return end_; }
    bool over(Time now) const { return end_ && now >= *end_; }
    /// None: it takes as long as it takes.
    std::optional<std::chrono::milliseconds> left(Time now) const;

    /// All pixels got so many samples in such a time.
    void took(std::uint32_t samples, std::chrono::duration<double> time);
    /// Of a picture that is to have `wanted` samples per pixel, and has `there`: how many it should have next. What is
    /// beyond whole blocks is rendered anew where more are wanted. The first step is one sample, as it shows how long
    /// others take; then go as many blocks together as take a part of what is left, growing step by step, and in the
    /// end as many samples as fit. 0: there is no time for more.
    std::uint32_t next(std::uint32_t there, std::uint32_t wanted, Time now) const;

private:
    std::optional<Time> end_;
    std::optional<double> seconds_per_sample_;
    std::uint32_t last_ = 0;  // samples of the last step
};

}  // namespace lightnet
