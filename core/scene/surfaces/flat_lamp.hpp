// A triangle or parallelogram that emits light, and points on it.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/math/rgb.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

/// Two sides of a triangle or parallelogram from one corner.
struct Facet {
    Vec3 corner, first_edge, second_edge, normal;

    /// Weights of the sides for a point that is uniform by area.
    static Vec2 uniform(Vec2 u, bool whole) { return whole ? u : triangle(u); }
    Vec3 at(Vec2 weights) const { return corner + first_edge * weights.x + second_edge * weights.y; }
};

/// From a point that is lit to one that was chosen on a facet, uniform by area.
struct DirectionToLamp {
    Vec3 direction;
    float pdf;   // per steradian
    bool found;  // else the lamp sends no light this way
};
/// Without a branch, as loops over many points want it.
inline DirectionToLamp direction_to_lamp(Vec3 from, Vec3 position, Vec3 normal, float area, bool two_sided) {
    const Vec3 way = position - from;
    const float distance2 = length_squared(way);
    const Vec3 direction = way / std::sqrt(distance2);
    const float towards = -dot(normal, direction), cosine = std::fabs(towards);
    const bool found = (distance2 > 0) & (cosine >= 1e-7f) & (two_sided | (towards > 0));
    return {direction, distance2 / (area * cosine), found};
}

/// Where a ray into `direction` ends that is to see that point of a facet: off it, on the side from which it comes. The
/// lamp itself is not in the way, as nothing of it is rounded so far.
inline Vec3 before_lamp(const Facet& facet, Vec3 position, Vec3 direction) {
    const Vec3 a = facet.first_edge, b = facet.second_edge;
    const float edges = std::sqrt(length_squared(a) + length_squared(b));  // longer than a third one over the root of 2
    const float offset = offset_at(position, facet.normal, 16 * rounding_step * edges);
    return off_surface(position, facet.normal, offset, -direction);
}

/// One that emits the same radiance everywhere.
struct FlatLamp {
    Facet facet;
    bool whole = false;  // a parallelogram
    float area = 0;      // m²
    Rgb radiance;
    bool two_sided = false;
    std::uint32_t group = 0;
};

}  // namespace lightnet
