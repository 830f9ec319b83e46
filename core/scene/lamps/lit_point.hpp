// A point that light may come to.
#pragma once

#include "core/base/math/shutter.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// Where light is looked for. A normal says that only what arrives on its side counts, and by its cosine; without one
/// light counts from everywhere. Densities of what was found hold for the same normal.
struct LitPoint {
    Vec3 position;
    Vec3 normal;           // unit, or nothing
    ShutterTime time = 0;  // at which lamps are looked for

    LitPoint() = default;
    /// Light counts from everywhere.
    explicit LitPoint(Vec3 at, ShutterTime when = 0) : position(at), time(when) {}
    LitPoint(Vec3 at, Vec3 towards_light, ShutterTime when = 0) : position(at), normal(towards_light), time(when) {}
    friend bool operator==(const LitPoint&, const LitPoint&) = default;
};

}  // namespace lightnet
