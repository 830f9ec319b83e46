// The contents of a scene, once each.
#pragma once

#include <cstdint>
#include <set>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// 0 of what is no mesh.
std::uint64_t triangles_of(const Shape& shape);
/// Of all shapes once, however many instances they stand in.
std::uint64_t triangles_of(const SceneData& scene);
/// Is any shape of it made of curves?
bool has_curves(const SceneData& scene);
/// All images of textures and environments, which may share them.
std::set<const Image*> images_of(const SceneData& scene);

}  // namespace lightnet
