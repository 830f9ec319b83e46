// Edits of a scene's lamps and materials, which can be made again and again of one that has been read.
#pragma once

#include <map>
#include <string>

#include "core/base/error.hpp"
#include "core/base/math/rgb.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// By names, * for any part of one. A value.
struct PartEdits {
    std::map<std::string, Rgb> lamps{};      // times which they shine
    std::map<std::string, Rgb> colours{};    // of materials, instead of theirs
    std::map<std::string, Rgb> roughness{};  // likewise, 0 … 1; red counts
    float environment_scale = 1;
};

/// Can edits be made of a scene that has been edited before? Where anything moves, it has to be read anew.
bool may_be_edited(const SceneData& scene);

/// Changes the scene as it was before the first such call. Two names may mean one lamp: both count then; of two for a
/// material, the last by the alphabet. Throws UserError, which names `where`, and leaves the scene as it was before the
/// first.
void edit_parts(const PartEdits& edits, SceneData& scene, const SourceLine& where);

}  // namespace lightnet
