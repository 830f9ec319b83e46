// A clear sky in daytime and its sun, as lamps of a scene.
#pragma once

#include <cstdint>
#include <numbers>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Half of the angle that the sun fills, radians, as Mitsuba has it. It goes from 0.263° to 0.272° over a year.
inline constexpr float angle_of_sun = 0.5358f / 2 * std::numbers::pi_v<float> / 180;

struct Daylight {
    Vec3 up{0, 1, 0}, to_sun{0, 0.70710678f, 0.70710678f};  // world space, unit; the sun is not below the horizon
    float turbidity = 3;                                    // haze, 1 … 10
    Rgb albedo{0.2f, 0.2f, 0.2f};                           // of the ground, 0 … 1
    float stretch = 1;      // the sky, and the sun's place in it, go so many times as far from the zenith; 1 … 2
    bool extended = false;  // it goes on below the horizon, more and more darkly
    float scale = 1;        // of all light, which else is in W·sr⁻¹·m⁻²·nm⁻¹
};

/// Its sky: a map of that many columns and half as many rows. 512 columns are within 0.5 % of the formula's light.
/// DECISIONS: skies-are-pictures
EnvironmentData sky_of(const Daylight& day, std::uint32_t columns = 512);

/// Radiance of the sun through the air, W·sr⁻¹·m⁻²·nm⁻¹, when it stands that far from the zenith (radians): Preetham,
/// Shirley & Smits 1999, "A Practical Analytic Model for Daylight", appendix 1.
Rgb radiance_of_sun(double from_zenith, double turbidity);
/// Its sun: a disk of that angle, with the light of one as wide as the real sun.
DirectionalLight sun_of(const Daylight& day, float half_angle = angle_of_sun);

}  // namespace lightnet
