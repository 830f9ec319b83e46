// Mitsuba's sensors and films.
#pragma once

#include "core/readers/mitsuba/properties.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::mitsuba {

/// Half a picture's width and height at distance 1.
struct Extent {
    double x = 1, y = 1;
};
/// Of what is seen, or thrown, by a lens on a picture of w by h: 'fov' with its axis, or 'focal_length'.
Extent extent_of(Properties& properties, double w, double h);

/// Between these planes across its axis a sensor of Mitsuba sees things; metres.
struct SensorDepth {
    float nearest = 0, farthest = 0;
};
/// Sets the camera and the film of the scene from a <sensor>.
SensorDepth set_sensor(const Node& node, const Context& context);

}  // namespace lightnet::mitsuba
