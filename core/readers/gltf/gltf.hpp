// Scenes in glTF 2.0.
#pragma once

#include "core/readers/common/scene_format.hpp"

namespace lightnet::gltf {

/// Of a file: its default scene, from its first camera.
SceneFormat format();

}  // namespace lightnet::gltf
