// Points, directions and normals in three dimensions; all lengths in metres (or the scene's unit).
#pragma once

#include <cmath>
#include <cstddef>

namespace lightnet {

struct Vec2 {
    float x = 0, y = 0;
    friend bool operator==(const Vec2&, const Vec2&) = default;
};

struct Vec3 {
    float x = 0, y = 0, z = 0;

    float& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    float operator[](std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    friend bool operator==(const Vec3&, const Vec3&) = default;
};

[[gnu::always_inline]] inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
[[gnu::always_inline]] inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
[[gnu::always_inline]] inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
[[gnu::always_inline]] inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
[[gnu::always_inline]] inline Vec3 operator*(float s, Vec3 a) { return a * s; }
[[gnu::always_inline]] inline Vec3 operator/(Vec3 a, float s) { return a * (1.0f / s); }
[[gnu::always_inline]] inline Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
[[gnu::always_inline]] inline Vec3& operator*=(Vec3& a, float s) { return a = a * s; }

[[gnu::always_inline]] inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[gnu::always_inline]] inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[gnu::always_inline]] inline float length_squared(Vec3 a) { return dot(a, a); }
[[gnu::always_inline]] inline float length(Vec3 a) { return std::sqrt(length_squared(a)); }
[[gnu::always_inline]] inline Vec3 normalize(Vec3 a) { return a / length(a); }
inline bool finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

[[gnu::always_inline]] inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
[[gnu::always_inline]] inline Vec2 operator*(Vec2 a, float s) { return {a.x * s, a.y * s}; }

}  // namespace lightnet
