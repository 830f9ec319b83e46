// A clear sky in daytime, and its sun.
#pragma once

#include <string>

#include "core/scene/data/scene_data.hpp"

namespace lightnet::mitsuba {

struct Sky {
    Vec3 to_sun{0, 1, 0};  // unit, before `to_world`; y is up
    float turbidity = 3;   // 2: very clear … 10: hazy
    Matrix to_world{};     // a rotation
    std::string sun{};     // how the sun is called
};

/// The analytic model of Preetham, Shirley & Smits 1999, "A Practical Analytic Model for Daylight", as an environment.
/// Its luminance is brought to radiance by 683 lm/W · 0.2, about daylight's luminous efficacy.
void add_sky(const Sky& sky, float scale, SceneData& scene);
/// The sun behind that air, as a directional light. None when it is below the horizon.
void add_sun(const Sky& sky, float scale, SceneData& scene);

}  // namespace lightnet::mitsuba
