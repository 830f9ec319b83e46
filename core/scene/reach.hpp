// The distance up to which things may stand.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Beyond this coordinate nothing is taken from a scene: products of coordinates have to be numbers, too, and Embree
/// takes no ray that begins beyond 1.8e18.
inline constexpr float farthest = 1e15f;

/// False for what is not finite, too.
inline bool in_reach(float coordinate) { return std::fabs(coordinate) <= farthest; }
inline bool in_reach(Vec3 p) { return in_reach(p.x) && in_reach(p.y) && in_reach(p.z); }
/// Directional lights always are.
bool in_reach(const BareLight& light);

/// Why a camera's rays can't be traced, for a picture of this film; "": they can.
std::string camera_fault(const CameraData& camera, const FilmData& film);

/// All that lies out of reach, as far as a scene's data says where it stands: shapes, instances of objects, cameras.
/// `file`: where there is no better place.
std::vector<Problem> out_of_reach(const SceneData& scene, const std::string& file);

}  // namespace lightnet
