// Triangles small enough to be moved one by one.
#pragma once

#include <cstdint>

#include "core/base/math/transform.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Halves the longest edge of each triangle until all are shorter than `longest`, where `to_world` puts them; what
/// vertices know is halfway between as well. Triangles that share an edge share its new vertices, so a closed mesh
/// stays closed. False: that would make more than `most` triangles.
bool split_edges(Mesh& mesh, const Matrix& to_world, float longest, std::uint64_t most);

/// Normals of vertices from the faces around each, whatever their size.
void normals_of_faces(Mesh& mesh);

}  // namespace lightnet
