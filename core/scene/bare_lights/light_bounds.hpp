// Bounds of lights, where one of them is chosen.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/math/box.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// Where some lights are and into which directions they shine: a box, and a cone of normals around which each of them
/// shines within an angle.
struct LightBounds {
    Vec3 low, high;
    Vec3 axis{0, 0, 1};    // unit
    float cos_spread = 1;  // of the greatest angle between the axis and a normal
    float cos_reach = 0;   // of the greatest angle, from a normal, at which light leaves; at most a right angle
    float intensity = 0;   // W·sr⁻¹, along the normals, of all together
    bool two_sided = false;
};

/// Around one light that moves, at two of its steps: as bright as where it is brightest.
inline LightBounds around_both(const LightBounds& a, const LightBounds& b) {
    Box box{a.low, a.high};
    box.add(b.low), box.add(b.high);
    const bool turns = !(a.axis == b.axis) || a.cos_spread != b.cos_spread || a.cos_reach != b.cos_reach;
    LightBounds both{box.low,
                     box.high,
                     a.axis,
                     a.cos_spread,
                     a.cos_reach,
                     std::max(a.intensity, b.intensity),
                     a.two_sided || b.two_sided};
    if (turns) both.cos_spread = -1, both.cos_reach = 0;
    return both;
}

/// One of them, and the chance with which it is chosen. Chance 0: no light reaches the point.
struct LightChoice {
    std::uint32_t light;
    float chance;
};

}  // namespace lightnet
