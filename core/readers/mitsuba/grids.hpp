// Mitsuba's shapes that grids of numbers describe, as meshes.
#pragma once

#include <optional>

#include "core/readers/mitsuba/textures.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::mitsuba {

/// A height field of version 0.6: [-1, 1]², the first row of its picture at y = -1. None: reported.
std::optional<Mesh> height_field(Properties& properties, Textures& textures);
/// Where the numbers of a grid in [0, 1]³ are 0. None: reported.
std::optional<Mesh> sdf_grid(Properties& properties, const Context& context);

}  // namespace lightnet::mitsuba
