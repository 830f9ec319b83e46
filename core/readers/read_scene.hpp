// The way in for scenes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/readers/common/scene_format.hpp"
#include "core/readers/files/files.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// The scene in the file at `path`; its ending tells the format. `constants` are values for the file's variables, which
/// not every format has. Opens files only through `files`. Throws UserError with all that is wrong; approximations
/// stand in the scene's warnings.
SceneData read_scene(Files& files, const std::string& path, const SceneConstants& constants = {});
/// The scene in a file of one of these formats, where read_scene() knows those of scene_formats() alone.
SceneData read_scene(Files& files, const std::string& path, const SceneConstants& constants,
                     std::span<const SceneFormat> formats);

/// What a scene is in a frame beside its own, as one of its constants.
struct FrameBeside {
    double seconds_per_frame = 0;
    std::optional<double> time{};  // of what moves in it; given where somebody asks how far things move
    std::string file{};            // "": the same
};
std::string to_constant(const FrameBeside& frame);

/// Is a scene's warning the one that hosts are sent files from outside of its folder?
bool is_of_files_outside(const Problem& warning);

/// All that there are.
std::span<const SceneFormat> scene_formats();
/// Those of a plugin, beside them, for the rest of the process. Throws Error, and adds none, where one has no ending,
/// can't be read, or has an ending that is taken. Before threads are started.
void add_scene_formats(const std::vector<SceneFormat>& formats);
/// The one of a file, by its ending. Null: none.
const SceneFormat* scene_format_of(const std::string& path);
/// The file's ending is that of one of them.
bool is_named_like_a_scene(const std::string& path);

}  // namespace lightnet
