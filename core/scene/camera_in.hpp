// The camera of a scene, given or not.
#pragma once

#include <cstdint>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// The camera that the scene gives. Where it gives none: in a room (closed all around its middle, but for windows, by
/// surfaces whose fronts are inside) one that stands inside, else one that sees all from outside. y is up. The same for
/// all who have read the scene.
CameraData camera_in(const SceneData& scene, std::uint32_t width, std::uint32_t height);

}  // namespace lightnet
