// Samples of light: directions towards lights, and light that leaves them.
#pragma once

#include <cstdint>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// A sampled direction towards a light.
struct LightSample {
    Vec3 position;   // of the emitting point; of no use when that is at infinity
    Vec3 direction;  // unit, from the lit point
    Rgb radiance;  // arriving, if nothing is in between; of a bare light its irradiance across the direction, W·m⁻²
    float pdf = 0;      // per steradian at the lit point, choice of the light included; > 0. Of a bare light the chance
                        // of its choice
    bool bare = false;  // no ray can meet this light: no other way finds it
    bool from_infinity = false;
    std::uint32_t group = 0;  // of the lamp: see Scene::groups()
};

/// Light that leaves a lamp.
struct Emission {
    Vec3 origin, direction;   // of the ray, off the lamp's surface; direction: unit
    Rgb flux;                 // W, over the density of all choices: its mean over samples is the power of all lights
    std::uint32_t group = 0;  // as for samples
};

}  // namespace lightnet
