// Light's way through media: where it collides, and what is left of it.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/math/random.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet {

/// Random numbers of one ray. Two of them are given, so that they can be well spread over many rays; further ones
/// follow from these and from the ray, so that the same ray finds the same wherever it is followed.
class FlightNumbers {
public:
    FlightNumbers(const Ray& ray, Vec2 first);
    float next();

private:
    Vec2 first_;
    Key key_;
    std::uint32_t used_ = 0;
};

/// Where light collided.
struct Collision {
    float distance;  // metres along the ray
    std::uint16_t medium;
};

/// What becomes of a path that follows a ray.
struct Flight {
    std::optional<Collision> collision;  // none: it gets to the ray's end
    Rgb weight{1, 1, 1};                 // of the path from there on: what light is left, over how likely this end was
    Rgb emitted{};                       // radiance of media on the way, as it arrives at the ray's beginning
};

}  // namespace lightnet
