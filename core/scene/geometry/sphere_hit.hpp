// Rays against a sphere.
#pragma once

#include <cmath>

#include "core/base/math/octahedral.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Calls `accept(distance, name)` with each point in (near, far) at which a ray meets the sphere, in order, until it
/// returns true; `name` is the point's octahedral normal. In double: single precision loses too much near the surface
/// that a ray leaves.
template <class Accept>
void meet(const Sphere& sphere, Vec3 origin, Vec3 direction, float near, float far, Accept accept) {
    const double dx = direction.x, dy = direction.y, dz = direction.z;
    const double fx = double{origin.x} - sphere.center.x, fy = double{origin.y} - sphere.center.y,
                 fz = double{origin.z} - sphere.center.z;
    const double a = dx * dx + dy * dy + dz * dz, half_b = fx * dx + fy * dy + fz * dz, r = sphere.radius;
    const double s = half_b / a;
    const double lx = fx - s * dx, ly = fy - s * dy, lz = fz - s * dz;  // from the centre to the line
    const double rest = r * r - (lx * lx + ly * ly + lz * lz);
    if (!(rest >= 0)) return;
    const double half_chord = std::sqrt(rest / a);
    for (const double root : {-s - half_chord, -s + half_chord}) {
        if (!(root > near && root < far)) continue;
        const auto t = float(root);
        if (accept(t, to_octahedral(normalize(origin + direction * t - sphere.center)))) return;
    }
}

}  // namespace lightnet
