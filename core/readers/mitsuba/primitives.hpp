// Mitsuba's simple shapes as meshes, in the shapes' own space, with texture coordinates as the scene has them: v
// upwards.
#pragma once

#include "core/scene/data/scene_data.hpp"

namespace lightnet::mitsuba {

/// [-1, 1]² at z = 0, seen from +z. With normals.
Mesh rectangle();
/// [-1, 1]³. With normals.
Mesh cube();

}  // namespace lightnet::mitsuba
