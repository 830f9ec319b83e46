// The identity of a scene, to the light in it.
#pragma once

#include "core/base/hash.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Names what light meets in a scene: surfaces, where they stand, what they are made of and covered with, and what
/// shines. Camera, film, names and the places of files don't count: another view of a room is the same room.
Hash identity_of(const SceneData& scene);

}  // namespace lightnet
