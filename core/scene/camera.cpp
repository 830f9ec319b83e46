#include "core/scene/camera.hpp"

#include <cmath>
#include <numbers>

namespace lightnet {
namespace {

// The shorter side of the picture spans ±1.
std::array<float, 4> screen_of(float width, float height) {
    const float aspect = width / height;
    if (aspect > 1) return {-aspect, aspect, -1, 1};
    return {-1, 1, -1 / aspect, 1 / aspect};
}

}  // namespace

Camera::Camera(const CameraData& data, std::uint32_t width, std::uint32_t height)
    : origin_(transform_point(data.to_world, {0, 0, 0})) {
    const float w = float(width), h = float(height);
    const auto [left, right, bottom, top] = data.screen_given ? data.screen : screen_of(w, h);
    const float depth = float(1 / std::tan(double{data.fov} * std::numbers::pi / 360));
    corner_ = transform_direction(data.to_world, {left, top, depth});
    right_ = transform_direction(data.to_world, {(right - left) / w, 0, 0});
    down_ = transform_direction(data.to_world, {0, (bottom - top) / h, 0});
}

Ray Camera::ray(float x, float y) const { return {origin_, normalize(corner_ + right_ * x + down_ * y)}; }

}  // namespace lightnet
