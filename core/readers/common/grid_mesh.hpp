// Meshes whose vertices lie in rows and columns.
#pragma once

#include <cstdint>
#include <span>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Two triangles for each cell of a grid of vertices, row after row, anticlockwise where x goes along rows and y
/// across.
void add_cells(Mesh& mesh, std::uint32_t columns, std::uint32_t rows);
/// Heights over the unit square, at least 2 × 2, row after row along y, which are its texture coordinates as well.
Mesh mesh_of_heights(std::uint32_t columns, std::uint32_t rows, std::span<const float> heights);

}  // namespace lightnet
