// Pictures that a user names.
#pragma once

#include <string>

#include "core/film/picture.hpp"

namespace lightnet {

/// The picture in a file: EXR with its layers, or HDR, PNG and JPEG. Throws Error.
Picture picture_in(const std::string& path);
/// Likewise, where it is the user's mistake if there is none. Throws UserError.
Picture picture_of_user(const std::string& file);
/// An EXR file with its layers. Throws UserError.
Picture layers_of_user(const std::string& file);

}  // namespace lightnet
