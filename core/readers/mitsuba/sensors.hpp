// Mitsuba's sensors and films.
#pragma once

#include "core/readers/mitsuba/properties.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::mitsuba {

/// Sets the camera and the film of the scene from a <sensor>.
void set_sensor(const Node& node, const Context& context);

}  // namespace lightnet::mitsuba
