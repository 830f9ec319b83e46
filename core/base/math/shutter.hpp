// Times while a shutter is open, as questions carry them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace lightnet {

/// 0 where the shutter opens, 65535 where it closes.
using ShutterTime = std::uint16_t;
inline constexpr ShutterTime shutter_closes = 65535;

/// Part of the time for which it is open, 0 … 1.
inline float part_of_shutter(ShutterTime time) { return float(time) / float(shutter_closes); }
/// The time for a random number in [0, 1): all are equally likely.
inline ShutterTime time_in_shutter(float u) { return ShutterTime(u * 65536.0f); }

/// A place among evenly spaced steps, from where the shutter opens to where it closes.
struct StepPlace {
    std::size_t step = 0;  // the one before it
    float part = 0;        // of the way to the next, 0 … 1

    /// Where the shutter has been open for so much of its time. `steps`: 2 or more.
    StepPlace(std::size_t steps, float open) {
        const float at = open * float(steps - 1);
        step = std::min(std::size_t(at), steps - 2);
        part = at - float(step);
    }
    StepPlace(std::size_t steps, ShutterTime time) : StepPlace(steps, part_of_shutter(time)) {}

    /// What lies there, as Embree goes from one step to the next.
    template <class T>
    T between(const T& before, const T& after) const {
        return before * (1 - part) + after * part;
    }
};

}  // namespace lightnet
