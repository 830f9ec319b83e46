// One point of a sphere.
#pragma once

#include "core/base/math/wide_vec.hpp"
#include "core/scene/shapes/offset.hpp"

namespace lightnet {

/// The point of a sphere into a direction (unit): the nearest to it that there is in single precision.
inline Vec3 on_ball(Vec3 center, float radius, Vec3 outwards) {
    return (WideVec3(center) + WideVec3(outwards) * double{radius}).rounded();
}

/// What unit vectors round, at that distance: own part of an offset.
inline float ball_offset(float radius) { return 8 * rounding_step * radius; }

}  // namespace lightnet
