// A format of scene files: its endings, and the function that reads them.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/readers/files/files.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Values for variables of a scene's file, by name.
using SceneConstants = std::map<std::string, std::string>;

/// Among these, at which time a scene is wanted (seconds), which of its animations, when a shutter is open (its opening
/// and its closing, seconds after that time), and what it is in the frames beside its own (see FrameBeside in
/// read_scene.hpp): names that no file can use.
inline constexpr std::string_view time_constant = "@time", animation_constant = "@animation",
                                  shutter_constant = "@shutter", previous_constant = "@previous",
                                  next_constant = "@next";
/// Before the name of an object: how often its faces are split.
inline constexpr std::string_view subdivision_constant = "@subdivision ";

/// One folder of core/readers, and one line in the table of read_scene.cpp; or brought by a plugin.
struct SceneFormat {
    std::vector<std::string_view> endings;  // of its main files, with the dot, in lower case
    std::string_view maker{};               // whose format it is, where the ending does not tell
    bool has_variables = false;             // else it is given no constants
    bool moves = false;                     // else it is not told of which time and animation it is to be read
    bool subdivides = false;                // else it is not told of what is subdivided
    /// Reads the main file of a scene and all that it names, through `files` alone. Throws UserError with all that is
    /// wrong; approximations stand in the scene's warnings.
    SceneData (*read)(Files& files, const std::string& path, const SceneConstants& constants) = nullptr;
    std::string plugin{};  // that has brought it; set by those who load it
};

}  // namespace lightnet
