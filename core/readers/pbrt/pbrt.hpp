// Scenes in the language of pbrt-v4.
#pragma once

#include "core/readers/common/scene_format.hpp"

namespace lightnet::pbrt {

SceneFormat format();

}  // namespace lightnet::pbrt
