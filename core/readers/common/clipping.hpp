// Clipping planes of cameras, across their axis.
#pragma once

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Nothing is seen `before` one plane and `beyond` another, metres along the camera's axis; for a scene all of whose
/// shapes are known. A plane before which nothing lies is left alone, so that rays begin at the eye, and so is one
/// beyond which nothing lies.
void clip(CameraData& camera, float before, float beyond, const SceneData& scene);

}  // namespace lightnet
