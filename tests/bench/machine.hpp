// How fast this machine is, beside the one for which goals in seconds hold.
#pragma once

#include <embree/rtcore.h>

#include <array>
#include <vector>

#include "core/base/math/vec.hpp"

namespace lightnet::bench {

/// Goals in seconds hold for a machine on which two threads of bare Embree, ray by ray, trace so many of a camera's
/// rays over the landscape, of those that leave what they meet, of those that leave that, and of the second kind as
/// shadows: in M rays/s.
inline constexpr std::array<double, 4> goals_hold_at{26.8, 8.1, 4.8, 8.4};

/// A landscape of a million triangles, and rays over it.
class Machine {
public:
    Machine();
    ~Machine();
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;

    /// What it traces now, as a part of what the goals' machine does: the geometric mean of the four, each the best of
    /// three, as those were. Takes two seconds and a half.
    double speed() const;

private:
    struct Flight {
        Vec3 origin, direction;
    };
    using Flights = std::vector<Flight>;
    Flights from_camera() const;
    Flights bounced(const Flights& arriving) const;
    double rate(const Flights& flights, bool shadows, bool coherent) const;

    RTCDevice device_;
    RTCScene scene_;
    std::array<Flights, 3> flights_;
};

}  // namespace lightnet::bench
