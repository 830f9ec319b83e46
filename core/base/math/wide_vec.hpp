// Points and directions in double, where single precision would lose what lies between them.
#pragma once

#include <cmath>

#include "core/base/math/vec.hpp"

namespace lightnet {

struct WideVec3 {
    double x = 0, y = 0, z = 0;

    WideVec3() = default;
    WideVec3(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    explicit WideVec3(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
    /// To the nearest in single precision.
    Vec3 rounded() const { return {float(x), float(y), float(z)}; }
};

inline WideVec3 operator+(WideVec3 a, WideVec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline WideVec3 operator-(WideVec3 a, WideVec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline WideVec3 operator*(WideVec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(WideVec3 a, WideVec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline WideVec3 cross(WideVec3 a, WideVec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(WideVec3 a) { return std::sqrt(dot(a, a)); }

}  // namespace lightnet
