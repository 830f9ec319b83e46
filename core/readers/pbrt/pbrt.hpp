// Scenes in the language of pbrt-v4.
#pragma once

#include <string>

#include "core/readers/files.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// Reads the main file of a scene and all that it names. Throws UserError with all that is wrong.
SceneData read(Files& files, const std::string& path);

}  // namespace lightnet::pbrt
