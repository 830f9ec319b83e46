// What `lightnet scene info` tells of a scene file.
#pragma once

#include <iosfwd>
#include <map>
#include <string>

namespace lightnet {

/// Reads and builds the scene in the file, its variables as `constants` say, and writes what there is to say about it.
/// Throws UserError.
void print_scene_info(const std::string& file, const std::map<std::string, std::string>& constants, std::ostream& out);

}  // namespace lightnet
