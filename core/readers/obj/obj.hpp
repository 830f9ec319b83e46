// OBJ files, alone as scenes.
#pragma once

#include <string>

#include "core/readers/files.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::obj {

/// The scene of an OBJ file and its MTL libraries: a shape per material. There is no camera in it, and no light but
/// those of emitting materials. Throws UserError with all that is wrong.
SceneData read(Files& files, const std::string& path);

}  // namespace lightnet::obj
