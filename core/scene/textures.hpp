// Colours over surfaces.
#pragma once

#include "core/math/rgb.hpp"
#include "core/math/vec.hpp"
#include "core/scene/scene_data.hpp"

namespace lightnet {

/// The texture's colour at texture coordinates: bilinear, not filtered over an area. Coordinate v counts upwards from
/// the image's bottom row.
Rgb look_up(const Texture& texture, Vec2 uv);

}  // namespace lightnet
