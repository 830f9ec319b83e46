#include "core/scene/camera/panoramas.hpp"

#include "core/base/math/sky_layout.hpp"
#include "core/scene/camera/camera_data.hpp"

namespace lightnet {
namespace {

// The inverse of a rotation that may have a mirror in it.
Matrix turned_back(const Matrix& turn) {
    Matrix back;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) back.m[i][j] = turn.m[j][i];
    return back;
}

}  // namespace

Surroundings::Surroundings(const CameraData& camera, Vec2 in_pixels)
    : to_world(camera.to_world),
      from_world(turned_back(camera.to_world)),
      origin(transform_point(camera.to_world, {0, 0, 0})),
      size(in_pixels) {}

Ray Surroundings::ray(Vec3 direction) const { return {origin, normalize(transform_direction(to_world, direction))}; }

Vec3 Surroundings::direction_to(Vec3 position) const {
    return normalize(transform_direction(from_world, position - origin));
}

Ray LatitudeLongitude::View::ray(float x, float y) const {
    const Vec3 there = from_latitude_longitude({x / around_.size.x, y / around_.size.y});
    return around_.ray({there.z, there.y, -there.x});
}

Vec3 LatitudeLongitude::View::project(Vec3 position) const {
    const Vec3 d = around_.direction_to(position);
    return around_.pixel(to_latitude_longitude({-d.z, d.y, d.x}));
}

Ray EqualArea::View::ray(float x, float y) const {
    const Vec3 there = from_equal_area({x / around_.size.x, y / around_.size.y});
    return around_.ray({there.x, there.z, there.y});
}

Vec3 EqualArea::View::project(Vec3 position) const {
    const Vec3 d = around_.direction_to(position);
    return around_.pixel(to_equal_area({d.x, d.z, d.y}));
}

}  // namespace lightnet
