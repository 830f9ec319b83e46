// The way in for scenes.
#pragma once

#include <map>
#include <string>

#include "core/readers/files.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// The scene in the file at `path`; its ending tells the language: ".pbrt", ".xml" (Mitsuba), ".gltf", ".glb", ".obj"
/// or ".ply". `constants` are values for the file's variables, which only Mitsuba's scenes have. Opens files only
/// through `files`. Throws UserError with all that is wrong; what was not taken literally stands in the scene's
/// warnings.
SceneData read_scene(Files& files, const std::string& path, const std::map<std::string, std::string>& constants = {});

/// Its ending is one of those.
bool is_named_like_a_scene(const std::string& path);

}  // namespace lightnet
