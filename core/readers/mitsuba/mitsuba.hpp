// Scenes in the XML of Mitsuba: version 3 and its forerunners 0.5, 0.6 and 2.
#pragma once

#include "core/readers/common/scene_format.hpp"

namespace lightnet::mitsuba {

/// Constants take the place of its <default>s.
SceneFormat format();

}  // namespace lightnet::mitsuba
