// A direction as two numbers: how a question names a point of a sphere.
#pragma once

#include <cmath>

#include "core/base/math/vec.hpp"

namespace lightnet {

/// Unit vector → [-1,1]². Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors".
inline Vec2 to_octahedral(Vec3 n) {
    const float s = 1.0f / (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
    const float x = n.x * s, y = n.y * s;
    if (n.z >= 0) return {x, y};
    return {std::copysign(1 - std::fabs(y), x), std::copysign(1 - std::fabs(x), y)};
}

/// The unit vector again, within a few ulps. Without a branch, so that loops over many become vectors.
inline Vec3 from_octahedral(Vec2 p) {
    const float z = 1 - std::fabs(p.x) - std::fabs(p.y);
    const float x = std::copysign(1 - std::fabs(p.y), p.x), y = std::copysign(1 - std::fabs(p.x), p.y);
    return normalize({z >= 0 ? p.x : x, z >= 0 ? p.y : y, z});
}

}  // namespace lightnet
