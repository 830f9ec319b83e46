// Rays against a sphere.
#pragma once

#include <cmath>

#include "core/base/math/octahedral.hpp"
#include "core/base/math/vec.hpp"
#include "core/base/math/wide_vec.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// How far along a ray a sphere is met: no numbers, if it is not. In double: single precision loses too much near the
/// surface that a ray leaves.
struct SphereCrossings {
    double first, second;
};
[[gnu::always_inline]] inline SphereCrossings crossings(Vec3 center, float radius, Vec3 origin, Vec3 direction) {
    const double dx = direction.x, dy = direction.y, dz = direction.z;
    const double fx = double{origin.x} - center.x, fy = double{origin.y} - center.y, fz = double{origin.z} - center.z;
    const double a = dx * dx + dy * dy + dz * dz, half_b = fx * dx + fy * dy + fz * dz, r = radius;
    const double s = half_b / a;
    const double lx = fx - s * dx, ly = fy - s * dy, lz = fz - s * dz;  // from the centre to the line
    const double rest = r * r - (lx * lx + ly * ly + lz * lz);
    const double half_chord = std::sqrt(rest / a);
    return {-s - half_chord, -s + half_chord};
}

/// Calls `accept(distance, name)` with each point in (near, far) at which a ray meets the sphere, in order, until it
/// returns true; `name` is the point's octahedral normal.
template <class Accept>
void meet(const Sphere& sphere, Vec3 origin, Vec3 direction, float near, float far, Accept accept) {
    const auto [first, second] = crossings(sphere.center, sphere.radius, origin, direction);
    for (const double root : {first, second}) {
        if (!(root > near && root < far)) continue;
        const WideVec3 outwards = WideVec3(origin) - WideVec3(sphere.center) + WideVec3(direction) * root;
        if (accept(float(root), to_octahedral(normalize(outwards.rounded())))) return;
    }
}

}  // namespace lightnet
