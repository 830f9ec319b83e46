// Scenes in the XML of Mitsuba: version 3 and its forerunners 0.5, 0.6 and 2.
#pragma once

#include <map>
#include <string>

#include "core/readers/files.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::mitsuba {

/// Reads the main file of a scene and all that it names. `definitions` give values to its variables, instead of those
/// of its <default>s. Throws UserError with all that is wrong.
SceneData read(Files& files, const std::string& path, const std::map<std::string, std::string>& definitions = {});

}  // namespace lightnet::mitsuba
