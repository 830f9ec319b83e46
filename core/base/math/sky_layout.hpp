// Two layouts of all directions in an image, in the environment's own axes.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/math/sampling.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// [0,1)², from the image's upper left corner → unit vector. +y is the top row, -z the middle, +x right of it.
inline Vec3 from_latitude_longitude(Vec2 p) {
    const float theta = pi * p.y, phi = 2 * pi * (p.x - 0.5f), sine = std::sin(theta);
    return {sine * std::sin(phi), std::cos(theta), -sine * std::cos(phi)};
}
inline Vec2 to_latitude_longitude(Vec3 d) {
    const float theta = std::atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y);
    return {0.5f + std::atan2(d.x, -d.z) / (2 * pi), theta / pi};
}

/// Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD": equal areas of the square are equal solid
/// angles. +z is its centre, -z its corners.
inline Vec3 from_equal_area(Vec2 p) {
    const float u = 2 * p.x - 1, v = 2 * p.y - 1, a = std::fabs(u), b = std::fabs(v);
    const float inwards = 1 - (a + b), r = 1 - std::fabs(inwards);
    const float phi = (r == 0 ? 1 : (b - a) / r + 1) * (pi / 4);
    const float z = std::copysign(1 - r * r, inwards), out = r * std::sqrt(std::max(0.0f, 2 - r * r));
    return {std::copysign(std::cos(phi) * out, u), std::copysign(std::sin(phi) * out, v), z};
}
inline Vec2 to_equal_area(Vec3 d) {
    const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
    const float r = std::sqrt((x * x + y * y) / (1 + z));  // √(1 - z), without cancellation
    float b = x + y > 0 ? r * std::atan2(y, x) * (2 / pi) : 0, a = r - b;
    if (d.z < 0) {
        std::swap(a, b);
        a = 1 - a;
        b = 1 - b;
    }
    return {(std::copysign(a, d.x) + 1) / 2, (std::copysign(b, d.y) + 1) / 2};
}

}  // namespace lightnet
