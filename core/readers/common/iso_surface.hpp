// The surface on which numbers of a grid are 0.
#pragma once

#include <cstdint>
#include <optional>

#include "core/scene/data/scene_data.hpp"
#include "core/scene/media/medium.hpp"

namespace lightnet {

/// In the unit cube, whose faces the outermost points of the grid lie on, by marching tetrahedra: six to each cell
/// around the same diagonal, so that neighbours meet (Doi & Koide 1991, "An Efficient Method of Triangulating
/// Equi-Valued Surfaces by Using Tetrahedral Cells"). Normals are the gradient's, towards what is above 0. None: it
/// would have more than `most` triangles.
std::optional<Mesh> iso_surface(const VolumeGrid& grid, std::uint64_t most);

}  // namespace lightnet
