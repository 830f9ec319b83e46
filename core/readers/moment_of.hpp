// Another time of a scene: the things that are elsewhere then.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Another time of a scene: what is not as it is at first, by its index.
struct Moment {
    std::map<std::uint32_t, ShapeGeometry> shapes;  // of meshes positions and normals alone
    std::map<std::uint32_t, Matrix> instances;
    std::map<std::uint32_t, BareLight> lights;
    std::vector<CameraData> cameras;            // that of the scene, then its list; none: it has other ones
    std::vector<std::uint32_t> other_shapes{};  // whose parts can't be followed: they stand still
    bool has_other_things = false;              // so many shapes, instances, lights: all but the cameras stands still
    bool looks_otherwise = false;               // colours, brightness of shapes, where suns stand: as at first
};

/// `there`: the scene at that time.
Moment moment_of(SceneData there, const SceneData& first);

/// What of a shape moves.
ShapeGeometry positions_of(ShapeGeometry shape);

/// The scene on the way from `first` to another time, of which `part` is 1; beyond it the way goes on. It is straight;
/// instances and cameras turn, see between().
SceneData on_the_way(const SceneData& first, const Moment& there, double part);

/// Sets what the scene is like a frame later.
void set_next_frame(SceneData& scene, SceneData there);

}  // namespace lightnet
