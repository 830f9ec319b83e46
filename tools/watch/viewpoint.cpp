#include "tools/watch/viewpoint.hpp"

#include <algorithm>
#include <variant>

namespace lightnet {

Viewpoint viewpoint_of(const CameraData& camera, const Box& around) {
    const auto& world = camera.to_world;
    const Vec3 from = transform_point(world, {0, 0, 0}), ahead = normalize(transform_direction(world, {0, 0, 1}));
    const float away = dot(around.center() - from, ahead), size = std::max(length(around.size()), 1e-3f);
    const bool has_fov = std::holds_alternative<Perspective>(camera.projection);
    return {from, from + ahead * (away > 1e-3f * size ? away : size), normalize(transform_direction(world, {0, 1, 0})),
            has_fov ? camera.fov : 0};
}

}  // namespace lightnet
