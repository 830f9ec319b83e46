// A ray, and what it hits.
#pragma once

#include <cstdint>
#include <limits>

#include "core/base/math/shutter.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

struct Ray {
    Vec3 origin;
    Vec3 direction;                                      // unit
    float far = std::numeric_limits<float>::infinity();  // metres along the direction
    ShutterTime time = 0;                                // at which it meets what moves
};

/// The ray on which nothing may be if `origin` is to see a lamp at `position`. Where they are one point, it goes into
/// `direction`, and nowhere. Without a branch, as loops over many rays want it.
inline Ray ray_between(Vec3 origin, Vec3 position, Vec3 direction, ShutterTime time = 0) {
    constexpr float nearly = 1 - 1e-4f;  // the lamp itself is not in the way
    const Vec3 way = position - origin;
    const float distance = length(way);
    const bool apart = distance > 0;
    const Vec3 along = way / distance;
    return {origin,
            {apart ? along.x : direction.x, apart ? along.y : direction.y, apart ? along.z : direction.z},
            apart ? distance * nearly : 0,
            time};
}

/// What names a point of a surface: no more than a Query carries.
struct Hit {
    std::uint32_t instance = 0xffffffffu;
    std::uint32_t geometry = 0;
    std::uint32_t primitive = 0;
    float u = 0, v = 0;    // barycentric; of spheres the octahedral normal; of quadrics and curves as PlacedQuadric and
                           // Curves name
    float distance = 0;    // along the ray; not part of the name
    ShutterTime time = 0;  // of its ray
};

}  // namespace lightnet
