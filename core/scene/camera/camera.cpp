#include "core/scene/camera/camera.hpp"

#include "core/base/math/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

AnyView view_of(const CameraData& data, Vec2 size) {
    return std::visit([&]<IsProjection P>(const P&) { return AnyView(typename P::View(data, size)); }, data.projection);
}

bool may_have_lens(const AnyProjection& projection) {
    return std::visit([]<IsProjection P>(const P&) { return P::has_lens; }, projection);
}

}  // namespace

Camera::Camera(const CameraData& data, std::uint32_t width, std::uint32_t height)
    : view_(view_of(data, {float(width), float(height)})),
      has_lens_(data.lens_radius > 0 && may_have_lens(data.projection)) {
    for (const CameraData& step : data.later) {
        later_.push_back(view_of(step, {float(width), float(height)}));
        has_lens_ |= step.lens_radius > 0 && may_have_lens(step.projection);
    }
}

Ray Camera::ray(const AnyView& view, Vec2 position, const Vec2* lens) const {
    const auto through = [&](const auto& one) {
        return lens ? one.ray(position.x, position.y, *lens) : one.ray(position.x, position.y);
    };
    return std::visit(through, view);
}

// Between two steps rays go evenly: whatever the projection, and whatever of the camera changes.
void Camera::rays(std::span<const Vec2> positions, std::span<const Vec2> lens, std::span<const ShutterTime> times,
                  std::span<Ray> rays) const {
    if (!moves()) {
        this->rays(positions, lens, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i].time = times[i];
        return;
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const StepPlace place(later_.size() + 1, times[i]);
        const Vec2* point = lens.empty() ? nullptr : &lens[i];
        const Ray before = ray(place.step == 0 ? view_ : later_[place.step - 1], positions[i], point);
        const Ray after = ray(later_[place.step], positions[i], point);
        const Vec3 direction = place.between(before.direction, after.direction);
        rays[i] = {place.between(before.origin, after.origin),
                   length_squared(direction) > 0 ? normalize(direction) : before.direction, before.far, times[i]};
    }
}

void Camera::rays(std::span<const Vec2> positions, std::span<const Vec2> lens, std::span<Ray> rays) const {
    const auto through = [&](const auto& view) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto [x, y] = positions[i];
            rays[i] = lens.empty() ? view.ray(x, y) : view.ray(x, y, lens[i]);
        }
    };
    std::visit(through, view_);
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
