// A point that light may come to.
#pragma once

#include "core/base/math/vec.hpp"

namespace lightnet {

/// Where light is looked for. A normal says that only what arrives on its side counts, and by its cosine; without one
/// light counts from everywhere. Densities of what was found hold for the same normal.
struct LitPoint {
    Vec3 position;
    Vec3 normal;  // unit, or nothing

    LitPoint() = default;
    /// Light counts from everywhere.
    explicit LitPoint(Vec3 at) : position(at) {}
    LitPoint(Vec3 at, Vec3 towards_light) : position(at), normal(towards_light) {}
    friend bool operator==(const LitPoint&, const LitPoint&) = default;
};

}  // namespace lightnet
