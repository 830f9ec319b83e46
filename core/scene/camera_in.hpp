// The camera of a scene, given or not.
#pragma once

#include <cstdint>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// The camera that the scene gives, or one that sees all of it. The same for all who have read the scene.
CameraData camera_in(const SceneData& scene, std::uint32_t width, std::uint32_t height);

}  // namespace lightnet
