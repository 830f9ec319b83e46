// The moment at which a file that moves is read.
#pragma once

#include <optional>
#include <string>

#include "core/readers/common/scene_format.hpp"

namespace lightnet {

/// Takes it, in seconds, out of what fills in the file's variables; none: no moment is wanted. Throws UserError where
/// one of several animations is: `whose` ("pbrt's motion has") no names.
std::optional<double> take_moment(SceneConstants& constants, const std::string& path, const std::string& whose);

}  // namespace lightnet
