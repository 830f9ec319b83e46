// Turns numbers in [0,1)² into points of disks, spheres and triangles. Every map is continuous almost everywhere, so
// that well stratified numbers give well stratified directions.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/math/vec.hpp"

namespace lightnet {

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inverse_pi = std::numbers::inv_pi_v<float>;

/// Sine and cosine of `x` in [-π/4, π/4], by their series: a few ulps, and the same on every libm.
struct SineCosine {
    float sine, cosine;
};
inline SineCosine sine_cosine_near_zero(float x) {
    const float q = x * x;
    return {x * (1 + q * (-1.0f / 6 + q * (1.0f / 120 + q * (-1.0f / 5040 + q * (1.0f / 362880))))),
            1 + q * (-0.5f + q * (1.0f / 24 + q * (-1.0f / 720 + q * (1.0f / 40320))))};
}

/// Uniform in the unit disk. Shirley & Chiu 1997, "A Low Distortion Map Between Disk and Square". Without a branch:
/// which of two cases it is can't be foretold.
inline Vec2 disk(Vec2 u) {
    const float a = 2 * u.x - 1, b = 2 * u.y - 1;
    const bool flat = std::fabs(a) > std::fabs(b);
    const float radius = flat ? a : b, other = flat ? b : a;
    const auto [sine, cosine] = sine_cosine_near_zero(pi / 4 * (other / (radius == 0 ? 1 : radius)));
    const float along = radius * cosine, aside = radius * sine;
    return {flat ? along : aside, flat ? aside : along};
}

/// Around +z, density cos θ / π per steradian.
inline Vec3 cosine_hemisphere(Vec2 u) {
    const Vec2 d = disk(u);
    return {d.x, d.y, std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y))};
}

/// Around +z within an angle, uniform: `one_minus_cosine` of the largest angle, in (0, 2]. Density 1 / (2π × it).
inline Vec3 cone(Vec2 u, float one_minus_cosine) {
    const Vec2 d = disk(u);
    const float r2 = d.x * d.x + d.y * d.y;
    const float drop = r2 * one_minus_cosine;                                     // 1 - cos θ
    const float spread = std::sqrt(one_minus_cosine * std::max(0.0f, 2 - drop));  // sin θ / r
    return {d.x * spread, d.y * spread, 1 - drop};
}

/// Uniform on the unit sphere, density 1 / 4π.
inline Vec3 sphere(Vec2 u) { return cone(u, 2); }

/// Barycentric weights of the second and third corner, uniform over a triangle.
/// Heitz 2019, "A Low-Distortion Map Between Triangle and Square".
inline Vec2 triangle(Vec2 u) {
    const float half = 0.5f * std::min(u.x, u.y);
    return {u.x - half, u.y - half};
}

}  // namespace lightnet
