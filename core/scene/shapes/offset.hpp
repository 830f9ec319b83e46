// The offset at which rays start from a surface, beyond what numbers in single precision round.
#pragma once

#include <cmath>

#include "core/base/math/vec.hpp"

namespace lightnet {

inline float largest_coordinate(Vec3 v) {
    const float x = std::fabs(v.x), y = std::fabs(v.y), z = std::fabs(v.z), xy = x > y ? x : y;
    return xy > z ? xy : z;
}
inline Vec3 magnitudes(Vec3 v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }

/// How far a number may lie from what was rounded to it, over its size.
inline constexpr float rounding_step = 0x1p-24f;

/// DECISIONS: tight-offsets
/// Along `normal`, beyond what is rounded where coordinates are as large as those of `position`: once in the point,
/// once in the start of its ray, and twice that for safety. `own`: the same of the shape, wherever it stands.
inline float offset_at(Vec3 position, Vec3 normal, float own) {
    return 4 * rounding_step * dot(magnitudes(position), magnitudes(normal)) + own;
}

/// A ray's start, that far off a surface.
inline Vec3 off_surface(Vec3 position, Vec3 normal, float offset, Vec3 direction) {
    return position + normal * (dot(direction, normal) < 0 ? -offset : offset);
}

}  // namespace lightnet
