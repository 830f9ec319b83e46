// OBJ files, alone as scenes.
#pragma once

#include "core/readers/common/scene_format.hpp"

namespace lightnet::obj {

/// The scene of an OBJ file and its MTL libraries: a shape per material. There is no camera in it, and no light but
/// those of emitting materials.
SceneFormat format();

}  // namespace lightnet::obj
