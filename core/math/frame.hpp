// An orthonormal basis around a normal, and the offset that keeps a ray from hitting the surface it leaves.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/math/vec.hpp"

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

/// Moves a surface point off its surface, to the side of `n`, by a distance that fits the precision of its coordinates.
/// Wächter & Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems 2019, chapter 6.
inline Vec3 offset_ray_origin(Vec3 p, Vec3 n) {
    constexpr float origin = 1.0f / 32.0f, float_scale = 1.0f / 65536.0f, int_scale = 256.0f;
    const auto shift = [&](float value, float normal) {
        const auto ulps = static_cast<std::int32_t>(int_scale * normal);
        const auto bits = std::bit_cast<std::int32_t>(value);
        const float moved = std::bit_cast<float>(bits + (value < 0 ? -ulps : ulps));
        return std::fabs(value) < origin ? value + float_scale * normal : moved;
    };
    return {shift(p.x, n.x), shift(p.y, n.y), shift(p.z, n.z)};
}

}  // namespace lightnet
