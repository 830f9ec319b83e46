// Linear colour with the primaries of sRGB: radiance in W·sr⁻¹·m⁻², or a reflectance, per channel.
#pragma once

#include <algorithm>
#include <cmath>

namespace lightnet {

struct Rgb {
    float r = 0, g = 0, b = 0;
    friend bool operator==(const Rgb&, const Rgb&) = default;
};

[[gnu::always_inline]] inline Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
[[gnu::always_inline]] inline Rgb operator-(Rgb a, Rgb b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
[[gnu::always_inline]] inline Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
[[gnu::always_inline]] inline Rgb operator*(Rgb a, float s) { return {a.r * s, a.g * s, a.b * s}; }
[[gnu::always_inline]] inline Rgb operator*(float s, Rgb a) { return a * s; }
[[gnu::always_inline]] inline Rgb operator/(Rgb a, float s) { return {a.r / s, a.g / s, a.b / s}; }
[[gnu::always_inline]] inline Rgb& operator+=(Rgb& a, Rgb b) { return a = a + b; }
[[gnu::always_inline]] inline Rgb& operator*=(Rgb& a, Rgb b) { return a = a * b; }
[[gnu::always_inline]] inline Rgb& operator*=(Rgb& a, float s) { return a = a * s; }

inline float max_component(Rgb a) { return std::max({a.r, a.g, a.b}); }
inline bool is_black(Rgb a) { return a.r == 0 && a.g == 0 && a.b == 0; }
inline bool finite(Rgb a) { return std::isfinite(a.r) && std::isfinite(a.g) && std::isfinite(a.b); }
/// Relative luminance, ITU-R BT.709.
inline float luminance(Rgb a) { return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b; }

}  // namespace lightnet
