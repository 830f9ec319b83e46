// Mitsuba's simple shapes as meshes, in the shapes' own space, with texture coordinates as the scene has them: v
// upwards.
#pragma once

#include "core/scene/data/scene_data.hpp"

namespace lightnet::mitsuba {

/// [-1, 1]² at z = 0, seen from +z. With normals.
Mesh rectangle();
/// [-1, 1]³. With normals.
Mesh cube();
/// Of radius 1 at z = 0, seen from +z; as large as the disk. With normals.
Mesh disk();
/// Around the z axis from 0 to 1, radius 1, normals outwards.
Mesh cylinder();
/// Radius 1, normals outwards.
Mesh ball();

}  // namespace lightnet::mitsuba
