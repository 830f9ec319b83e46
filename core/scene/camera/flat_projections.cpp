#include "core/scene/camera/flat_projections.hpp"

#include "core/base/math/sampling.hpp"
#include "core/scene/camera/camera_data.hpp"

#include <cmath>
#include <numbers>

namespace lightnet {
namespace {

// By Cramer's rule, position - origin = a × first + b × second + c × third.
Vec3 in_terms_of(Vec3 way, Vec3 first, Vec3 second, Vec3 third) {
    const auto volume = [](Vec3 a, Vec3 b, Vec3 c) { return dot(a, cross(b, c)); };
    const float all = volume(first, second, third);
    return {volume(way, second, third) / all, volume(first, way, third) / all, volume(first, second, way) / all};
}

}  // namespace

std::array<float, 4> screen_of(float width, float height) {
    const float aspect = width / height;
    if (aspect > 1) return {-aspect, aspect, -1, 1};
    return {-1, 1, -1 / aspect, 1 / aspect};
}

double screen_distance(const CameraData& camera) { return 1 / std::tan(double{camera.fov} * std::numbers::pi / 360); }

FlatScreen::FlatScreen(const CameraData& camera, Vec2 size, float depth, float corner_depth)
    : origin(transform_point(camera.to_world, {0, 0, 0})), nearest(camera.nearest), farthest(camera.farthest) {
    const auto [left, right_end, bottom, top] = camera.screen_given ? camera.screen : screen_of(size.x, size.y);
    corner = transform_direction(camera.to_world, {left, top, corner_depth});
    right = transform_direction(camera.to_world, {(right_end - left) / size.x, 0, 0});
    down = transform_direction(camera.to_world, {0, (bottom - top) / size.y, 0});
    axis = transform_direction(camera.to_world, {0, 0, 1});
    lens_x = transform_direction(camera.to_world, {camera.lens_radius, 0, 0});
    lens_y = transform_direction(camera.to_world, {0, camera.lens_radius, 0});
    focus = camera.focus_distance / depth;
}

Vec3 FlatScreen::aside(Vec2 lens) const {
    const Vec2 d = disk(lens);
    return lens_x * d.x + lens_y * d.y;
}

Ray FlatScreen::within_sight(const Ray& ray) const {
    if (!(nearest > 0) && !std::isfinite(farthest)) return ray;
    const float ahead = dot(ray.direction, normalize(axis));
    return {ray.origin + ray.direction * (nearest / ahead), ray.direction, (farthest - nearest) / ahead};
}

Perspective::View::View(const CameraData& camera, Vec2 size)
    : screen_(camera, size, float(screen_distance(camera)), float(screen_distance(camera))) {}

Ray Perspective::View::ray(float x, float y) const {
    return screen_.within_sight({screen_.origin, normalize(screen_.at(x, y))});
}

Ray Perspective::View::ray(float x, float y, Vec2 lens) const {
    const Vec3 at = screen_.at(x, y), aside = screen_.aside(lens);
    return screen_.within_sight({screen_.origin + aside, normalize(at * screen_.focus - aside)});
}

Vec3 Perspective::View::project(Vec3 position) const {
    return in_terms_of(position - screen_.origin, screen_.right, screen_.down, screen_.corner);
}

Orthographic::View::View(const CameraData& camera, Vec2 size) : screen_(camera, size, 1, 0) {}

Ray Orthographic::View::ray(float x, float y) const {
    return screen_.within_sight({screen_.origin + screen_.at(x, y), normalize(screen_.axis)});
}

Ray Orthographic::View::ray(float x, float y, Vec2 lens) const {
    const Vec3 at = screen_.at(x, y), aside = screen_.aside(lens);
    return screen_.within_sight({screen_.origin + at + aside, normalize(screen_.axis * screen_.focus - aside)});
}

Vec3 Orthographic::View::project(Vec3 position) const {
    const Vec3 at = in_terms_of(position - screen_.origin - screen_.corner, screen_.right, screen_.down, screen_.axis);
    return {at.x, at.y, 1};
}

}  // namespace lightnet
