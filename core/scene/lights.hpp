// Choosing points on lights.
#pragma once

#include <cstdint>
#include <optional>

#include "core/math/rgb.hpp"
#include "core/math/vec.hpp"
#include "core/scene/ray.hpp"

namespace lightnet {

/// A sampled direction towards a light.
struct LightSample {
    Vec3 direction;         // unit, from the lit point
    float distance = 0;     // metres; infinite for an environment
    Rgb radiance;           // arriving, if nothing is in between
    float pdf = 0;          // per steradian at the lit point, choice of the light included; > 0
};

}  // namespace lightnet
