// Noise for textures, as pbrt has it.
#pragma once

#include <cstdint>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// Perlin 2002, "Improving Noise", but for four of its sixteen slopes, which are pbrt's: 0 at all points whose
/// coordinates are whole, between about -1 and 1 elsewhere.
float noise(Vec3 p);

/// Octaves of noise, each of 1.99 times the frequency of the one before and `roughness` times its height.
float fractal_noise(Vec3 p, std::int32_t octaves, float roughness);
/// Octaves of the noise's magnitude, added up as in fractal_noise(): creased.
float turbulence(Vec3 p, std::int32_t octaves, float roughness);
/// Waves of water under a wind that differs from place to place.
float wind_waves(Vec3 p);

/// Is there a dot? In about two of five squares of side 1, around points whose coordinates are whole, there is one.
bool in_dot(Vec2 at);

/// Where veins lie that are drawn across the y axis, and what colour they have there.
Rgb marble(Vec3 p, std::int32_t octaves, float roughness, float variation);

}  // namespace lightnet
