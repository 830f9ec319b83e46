// Two layouts of all directions in an image, in the environment's own axes.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/math/sampling.hpp"
#include "core/base/math/turns.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// [0,1)², from the image's upper left corner → unit vector. +y is the top row, -z the middle, +x right of it.
[[gnu::always_inline]] inline Vec3 from_latitude_longitude(Vec2 p) {
    const auto theta = sine_cosine_of_turns(0.5f * p.y), phi = sine_cosine_of_turns(p.x - 0.5f);
    return {theta.sine * phi.sine, theta.cosine, -theta.sine * phi.cosine};
}
[[gnu::always_inline]] inline Vec2 to_latitude_longitude(Vec3 d) {
    return {0.5f + turns(d.x, -d.z), 2 * turns(std::sqrt(d.x * d.x + d.z * d.z), d.y)};
}

/// Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD": equal areas of the square are equal solid
/// angles. +z is its centre, -z its corners.
[[gnu::always_inline]] inline Vec3 from_equal_area(Vec2 p) {
    const float u = 2 * p.x - 1, v = 2 * p.y - 1, a = std::fabs(u), b = std::fabs(v);
    const float inwards = 1 - (a + b), r = 1 - std::fabs(inwards);
    // from the nearer axis, at most π/4, of which the series is good
    const float from_x = (b - a) / (r > 0 ? r : 1) + 1, from_y = 2 - from_x;
    const bool by_x = from_x < from_y;
    const auto [small, large] = sine_cosine_near_zero(pi / 4 * (by_x ? from_x : from_y));
    const float z = std::copysign(1 - r * r, inwards), out = r * std::sqrt(std::max(0.0f, 2 - r * r));
    return {std::copysign((by_x ? large : small) * out, u), std::copysign((by_x ? small : large) * out, v), z};
}
[[gnu::always_inline]] inline Vec2 to_equal_area(Vec3 d) {
    const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
    const float r = std::sqrt((x * x + y * y) / (1 + z));  // √(1 - z), without cancellation
    const float across = r * (4 * turns(y, x)), along = r - across;
    const bool below = d.z < 0;
    const float a = below ? 1 - across : along, b = below ? 1 - along : across;
    return {(std::copysign(a, d.x) + 1) / 2, (std::copysign(b, d.y) + 1) / 2};
}

}  // namespace lightnet
