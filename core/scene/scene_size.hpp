// How large a scene is.
#pragma once

#include "core/scene/geometry.hpp"
#include "core/scene/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/scene_data.hpp"

namespace lightnet {

SceneSize size_of(const SceneData& data, const Geometry& geometry, const Lights& lights);

}  // namespace lightnet
