#include "core/scene/screen_motion.hpp"

#include <optional>
#include <span>
#include <variant>

#include "core/base/math/octahedral.hpp"
#include "core/base/math/transform.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/shapes/ball.hpp"
#include "core/scene/shapes/placed_quadric.hpp"

namespace lightnet {
namespace {

Vec3 axis(const Matrix& rotation, std::size_t i) {
    return {float(rotation.m[0][i]), float(rotation.m[1][i]), float(rotation.m[2][i])};
}

// Where the point of a shape as it is now lies on the shape as it is later.
Vec3 later_place(const Mesh& now, const Mesh& later, const SurfacePoint& point) {
    const auto [a, b, c] = now.triangles[point.primitive];
    return later.positions[a] * (1 - point.u - point.v) + later.positions[b] * point.u + later.positions[c] * point.v;
}
Vec3 later_place(const Sphere& now, const Sphere& later, const SurfacePoint& point) {
    const Vec3 outwards = from_octahedral({point.u, point.v});
    Vec3 turned;
    for (std::size_t i = 0; i < 3; ++i)
        turned = turned + axis(later.to_world, i) * dot(axis(now.to_world, i), outwards);
    return on_ball(later.center, later.radius, normalize(turned));
}
Vec3 later_place(const Quadric&, const Quadric& later, const SurfacePoint& point) {
    const PlacedQuadric placed(later);
    return placed.position(placed.own_point({point.u, point.v}));
}
Vec3 later_place(const Curves&, const Curves&, const SurfacePoint& point) {
    return point.position;
}  // they stand still

/// None: it is not before the eye.
std::optional<Vec2> pixel(const Camera& camera, Vec3 position) {
    const Vec3 p = camera.project(position);
    if (!(p.z > 0)) return std::nullopt;
    return Vec2{p.x / p.z, p.y / p.z};
}

Camera camera_of(const Scene& scene, const CameraData& data) {
    return Camera(data, scene.film().width, scene.film().height);
}

const CameraData& later_of(const CameraData& now) { return now.next.empty() ? now : now.next.front(); }

}  // namespace

ScreenMotion::ScreenMotion(const Scene& scene)
    : scene_(scene), now_(camera_of(scene, scene.seen_from())), later_(camera_of(scene, later_of(scene.seen_from()))) {}

Vec3 ScreenMotion::later_on_shape(const SurfacePoint& point) const {
    const auto& next = scene_.data().next;
    const auto steps =
        next ? SceneMotion::steps_after(next->motion.shapes, point.geometry) : std::span<const ShapeGeometry>{};
    if (steps.empty()) return point.position;
    return std::visit(
        [&](const auto& now) { return later_place(now, std::get<std::decay_t<decltype(now)>>(steps.front()), point); },
        scene_.data().shapes[point.geometry].geometry);
}

Vec2 ScreenMotion::of(const Query& question) const {
    Query first = question;
    first.time = 0;
    Vec3 now, later;
    if (question.is_in_space()) {
        now = later = question.place_in_space();
    } else {
        first.instance = Query::no_instance;
        const SurfacePoint point = scene_.surface(first);
        now = point.position, later = later_on_shape(point);
        if (question.instance != Query::no_instance) {
            const auto& next = scene_.data().next;
            const Matrix& at = scene_.data().instances.at(question.instance).to_world;
            const auto steps =
                next ? SceneMotion::steps_after(next->motion.instances, question.instance) : std::span<const Matrix>{};
            now = transform_point(at, now), later = transform_point(steps.empty() ? at : steps.front(), later);
        }
    }
    const auto from = pixel(now_, now), to = pixel(later_, later);
    if (!from || !to) return {};
    return {to->x - from->x, from->y - to->y};
}

}  // namespace lightnet
