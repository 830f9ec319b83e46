// PLY files, alone as scenes.
#pragma once

#include "core/readers/common/scene_format.hpp"

namespace lightnet::ply {

/// A mesh, diffuse and in the colours of its vertices, or grey.
SceneFormat format();

}  // namespace lightnet::ply
