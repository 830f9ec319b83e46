// Mitsuba's sensors and films.
#pragma once

#include "core/readers/mitsuba/properties.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::mitsuba {

/// Between these planes across its axis a sensor of Mitsuba sees things; metres.
struct SensorDepth {
    float nearest = 0, farthest = 0;
};
/// Sets the camera and the film of the scene from a <sensor>.
SensorDepth set_sensor(const Node& node, const Context& context);

}  // namespace lightnet::mitsuba
