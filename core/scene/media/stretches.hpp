// A ray's way through one medium.
#pragma once

#include <cstdint>

#include "core/scene/media/bounds.hpp"
#include "core/scene/media/flight.hpp"
#include "core/scene/media/medium.hpp"

namespace lightnet {

/// Distances along a ray, metres.
struct Stretch {
    float begin, end;
    std::uint16_t medium;
};

/// What becomes of a path on a stretch; false: it collides, or ends. Of a medium that is the same everywhere.
bool fly_even(const Medium& medium, const Stretch& way, Rgb carried, FlightNumbers& numbers, Flight& flight);
/// What becomes of a path on a stretch through any other medium.
bool fly_uneven(const Medium& medium, const CollisionBounds& bounds, const Ray& ray, const Stretch& way, Rgb carried,
                FlightNumbers& numbers, Flight& flight);
/// What is left of light after so many metres, in a medium whose extinction is the same everywhere.
Rgb left_along(const Medium& medium, float length);
/// Takes from `light` what collides on a stretch of any other; false: nothing is left.
bool let_through(const Medium& medium, const CollisionBounds& bounds, const Ray& ray, const Stretch& way,
                 FlightNumbers& numbers, Rgb& light);

}  // namespace lightnet
