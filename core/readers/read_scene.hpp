// The way in for scenes.
#pragma once

#include <span>
#include <string>

#include "core/readers/files.hpp"
#include "core/readers/scene_format.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// The scene in the file at `path`; its ending tells the format. `constants` are values for the file's variables, which
/// not every format has. Opens files only through `files`. Throws UserError with all that is wrong; approximations
/// stand in the scene's warnings.
SceneData read_scene(Files& files, const std::string& path, const SceneConstants& constants = {});
/// The same for other formats than those of scene_formats().
SceneData read_scene(Files& files, const std::string& path, const SceneConstants& constants,
                     std::span<const SceneFormat> formats);

/// All that there are.
std::span<const SceneFormat> scene_formats();
/// The file's ending is that of one of them.
bool is_named_like_a_scene(const std::string& path);

}  // namespace lightnet
