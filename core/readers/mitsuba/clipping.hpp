// Clipping planes of Mitsuba's sensors, across their axis.
#pragma once

#include "core/readers/mitsuba/properties.hpp"

namespace lightnet::mitsuba {

/// For the scene's camera, once all its shapes are known. A plane before which nothing lies is left alone, so that
/// rays begin at the eye; what lies too far away is named.
void clip(CameraData& camera, float nearest, float farthest, const Context& context);

}  // namespace lightnet::mitsuba
