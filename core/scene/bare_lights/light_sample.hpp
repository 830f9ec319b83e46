// Samples of light: directions towards lights, and light that leaves them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/math/columns.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// A sampled direction towards a light.
struct LightSample {
    Vec3 position;   // of the emitting point, off its surface; of no use when that is at infinity
    Vec3 direction;  // unit, from the lit point
    Rgb radiance;  // arriving, if nothing is in between; of a bare light its irradiance across the direction, W·m⁻²
    float pdf = 0;      // per steradian at the lit point, choice of the light included; > 0. Of a bare light the chance
                        // of its choice
    bool bare = false;  // no ray can meet this light: no other way finds it
    bool from_infinity = false;
    std::uint32_t group = 0;  // of the lamp: see Scene::groups()
    friend bool operator==(const LightSample&, const LightSample&) = default;
};

/// Those of many points, as a structure of arrays.
struct LightSamples {
    Columns3 position, direction, radiance;
    Column pdf;
    Flags found, bare, from_infinity, group;

    void set(std::size_t i, const std::optional<LightSample>& sample) {
        const LightSample& s = sample ? *sample : nowhere;
        position.set(i, s.position);
        direction.set(i, s.direction);
        radiance.set(i, {s.radiance.r, s.radiance.g, s.radiance.b});
        pdf[i] = s.pdf;
        found[i] = sample.has_value();
        bare[i] = s.bare;
        from_infinity[i] = s.from_infinity;
        group[i] = s.group;
    }
    LightSample operator[](std::size_t i) const {
        const Vec3 light = radiance[i];
        return {position[i],           direction[i], {light.x, light.y, light.z}, pdf[i], bare[i] != 0,
                from_infinity[i] != 0, group[i]};
    }

private:
    // Numbers as good as any, for loops that don't ask what was found.
    static constexpr LightSample nowhere{{}, {0, 0, 1}, {}, 1, false, true, 0};
};

/// What comes from infinity.
struct SkyRadiance {
    Vec3 direction;  // towards it, unit
    Rgb radiance;
    float pdf = 0;  // with which sampling lights finds it, per steradian
};

/// A sun, or several of them, in one direction.
struct SeenSun {
    SkyRadiance light;
    std::uint32_t group = 0;  // as for samples
    float free = 0;  // metres along the ray before which nothing may be in its way: else the light is not there
};

/// Light that leaves a lamp.
struct Emission {
    Vec3 origin, direction;   // of the ray, off the lamp's surface; direction: unit
    Rgb flux;                 // W, over the density of all choices: its mean over samples is the power of all lights
    std::uint32_t group = 0;  // as for samples
    float free = 0;  // metres along the ray before which nothing may be in its way: else the light is not there
};

}  // namespace lightnet
