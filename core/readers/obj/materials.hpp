// The materials of MTL files.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/readers/common/assets.hpp"

namespace lightnet::obj {

struct Surface {
    MaterialId material = 0;
    std::optional<AreaEmission> emission;
};

/// Reads the library at `path` and adds its materials to the scene; the first of a name counts. What is wrong is
/// reported with its line.
void read_materials(const std::string& path, const SourceLine& where, Assets& assets,
                    std::map<std::string, Surface>& materials);

}  // namespace lightnet::obj
