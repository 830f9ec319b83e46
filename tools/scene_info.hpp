// What `lightnet scene info` tells of a scene file.
#pragma once

#include <iosfwd>
#include <string>

namespace lightnet {

/// Reads and builds the scene in the file, and writes what there is to say about it. Throws UserError.
void print_scene_info(const std::string& file, std::ostream& out);

}  // namespace lightnet
