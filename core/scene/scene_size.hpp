// The size of a scene.
#pragma once

#include "core/scene/data/scene_data.hpp"
#include "core/scene/geometry/geometry.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

SceneSize size_of(const SceneData& data, const Geometry& geometry, const Lights& lights);

}  // namespace lightnet
