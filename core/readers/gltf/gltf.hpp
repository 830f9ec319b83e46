// Scenes in glTF 2.0.
#pragma once

#include <string>

#include "core/readers/files.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::gltf {

/// Reads a .gltf or .glb file and all that it names: its default scene, from its first camera. Throws UserError with
/// all that is wrong.
SceneData read(Files& files, const std::string& path);

}  // namespace lightnet::gltf
