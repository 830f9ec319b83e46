// An orthonormal basis around a normal.
#pragma once

#include <cmath>

#include "core/base/math/vec.hpp"

namespace lightnet {

/// Local coordinates in which the normal is +z.
struct Frame {
    Vec3 x, y, z;

    /// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3.
    static Frame around(Vec3 n) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }
    Vec3 to_local(Vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    Vec3 to_world(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
};

}  // namespace lightnet
