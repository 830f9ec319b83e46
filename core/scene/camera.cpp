#include "core/scene/camera.hpp"

#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/sky_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightnet {
namespace {

// The inverse of a rotation that may have a mirror in it.
Matrix turned_back(const Matrix& turn) {
    Matrix back;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) back.m[i][j] = turn.m[j][i];
    return back;
}

}  // namespace

std::array<float, 4> screen_of(float width, float height) {
    const float aspect = width / height;
    if (aspect > 1) return {-aspect, aspect, -1, 1};
    return {-1, 1, -1 / aspect, 1 / aspect};
}

Camera::Camera(const CameraData& data, std::uint32_t width, std::uint32_t height)
    : orthographic_(data.orthographic),
      has_lens_(data.lens_radius > 0 && data.panorama == CameraData::Panorama::none),
      panorama_(data.panorama),
      to_world_(data.to_world),
      from_world_(turned_back(data.to_world)),
      size_{float(width), float(height)},
      origin_(transform_point(data.to_world, {0, 0, 0})) {
    const float w = float(width), h = float(height);
    const auto [left, right, bottom, top] = data.screen_given ? data.screen : screen_of(w, h);
    const float depth = orthographic_ ? 1 : float(1 / std::tan(double{data.fov} * std::numbers::pi / 360));
    corner_ = transform_direction(data.to_world, {left, top, orthographic_ ? 0 : depth});
    right_ = transform_direction(data.to_world, {(right - left) / w, 0, 0});
    down_ = transform_direction(data.to_world, {0, (bottom - top) / h, 0});
    axis_ = transform_direction(data.to_world, {0, 0, 1});
    lens_x_ = transform_direction(data.to_world, {data.lens_radius, 0, 0});
    lens_y_ = transform_direction(data.to_world, {0, data.lens_radius, 0});
    focus_ = data.focus_distance / depth;
    nearest_ = data.nearest;
}

Ray Camera::from_nearest(const Ray& ray) const {
    if (!(nearest_ > 0)) return ray;
    const float ahead = dot(ray.direction, normalize(axis_));
    return {ray.origin + ray.direction * (nearest_ / ahead), ray.direction, ray.far};
}

Ray Camera::around(float x, float y) const {
    const Vec2 at{x / size_.x, y / size_.y};
    Vec3 d;
    if (panorama_ == CameraData::Panorama::equal_area) {
        const Vec3 there = from_equal_area(at);
        d = {there.x, there.z, there.y};
    } else {
        const Vec3 there = from_latitude_longitude(at);
        d = {there.z, there.y, -there.x};
    }
    return {origin_, normalize(transform_direction(to_world_, d))};
}

Ray Camera::ray(float x, float y) const {
    if (panorama_ != CameraData::Panorama::none) return around(x, y);
    const Vec3 at = corner_ + right_ * x + down_ * y;
    if (orthographic_) return from_nearest({origin_ + at, normalize(axis_)});
    return from_nearest({origin_, normalize(at)});
}

Ray Camera::ray(float x, float y, Vec2 lens) const {
    if (panorama_ != CameraData::Panorama::none) return around(x, y);
    const Vec3 at = corner_ + right_ * x + down_ * y;
    const Vec2 d = disk(lens);
    const Vec3 aside = lens_x_ * d.x + lens_y_ * d.y;
    if (orthographic_) return from_nearest({origin_ + at + aside, normalize(axis_ * focus_ - aside)});
    return from_nearest({origin_ + aside, normalize(at * focus_ - aside)});
}

void Camera::rays(std::span<const Vec2> positions, std::span<const Vec2> lens, std::span<Ray> rays) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto [x, y] = positions[i];
        rays[i] = lens.empty() ? ray(x, y) : ray(x, y, lens[i]);
    }
}

// Solves position - origin = corner w + right x + down y (perspective), or corner + right x + down y + axis d, by
// Cramer's rule.
Vec3 Camera::project(Vec3 position) const {
    if (panorama_ != CameraData::Panorama::none) {
        const Vec3 d = normalize(transform_direction(from_world_, position - origin_));
        const bool squares = panorama_ == CameraData::Panorama::equal_area;
        const Vec2 at = squares ? to_equal_area({d.x, d.z, d.y}) : to_latitude_longitude({-d.z, d.y, d.x});
        return {at.x * size_.x, at.y * size_.y, 1};
    }
    const Vec3 third = orthographic_ ? axis_ : corner_;
    const Vec3 from = orthographic_ ? position - origin_ - corner_ : position - origin_;
    const auto volume = [](Vec3 a, Vec3 b, Vec3 c) { return dot(a, cross(b, c)); };
    const float all = volume(right_, down_, third);
    const float x = volume(from, down_, third) / all, y = volume(right_, from, third) / all;
    return {x, y, orthographic_ ? 1 : volume(right_, down_, from) / all};
}

CameraData camera_for(Vec3 low, Vec3 high, std::uint32_t width, std::uint32_t height) {
    constexpr float fov = 40, margin = 1.05f;
    const Vec3 center = (low + high) * 0.5f, half = (high - low) * 0.5f;
    const Vec3 z = normalize({-0.55f, -0.45f, -1}), x = normalize(cross(z, {0, 1, 0})), y = cross(x, z);
    const auto screen = screen_of(float(width), float(height));
    const float slope = std::tan(fov * pi / 360);
    float away = 1e-3f;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p{corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z};
        const float aside = std::max(std::fabs(dot(p, x)) / screen[1], std::fabs(dot(p, y)) / screen[3]);
        away = std::max(away, aside * margin / slope - dot(p, z));
    }
    const Vec3 eye = center - z * away;
    CameraData camera;
    camera.fov = fov;
    for (std::size_t i = 0; i < 3; ++i) {
        camera.to_world.m[i][0] = x[i];
        camera.to_world.m[i][1] = y[i];
        camera.to_world.m[i][2] = z[i];
        camera.to_world.m[i][3] = eye[i];
    }
    return camera;
}

}  // namespace lightnet
