// Are the materials of a scene sound?
#pragma once

#include <cstddef>
#include <span>

#include "core/scene/bsdf/material.hpp"

namespace lightnet {

/// Throws Error where a material names a texture or a material that isn't there, or is mixed from itself, and where
/// mixtures are deeper or larger than any that makes sense: a surface's light is worked out for each part alone.
void check_materials(std::span<const Material> materials, std::size_t textures);

}  // namespace lightnet
