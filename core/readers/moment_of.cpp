#include "core/readers/moment_of.hpp"

#include <type_traits>
#include <utility>
#include <variant>

namespace lightnet {
namespace {

bool same_place(const Mesh& a, const Mesh& b) { return a.positions == b.positions && a.normals == b.normals; }
bool same_place(const Sphere& a, const Sphere& b) {
    return a.center == b.center && a.radius == b.radius && a.to_world.m == b.to_world.m;
}
bool same_place(const Quadric& a, const Quadric& b) { return a.to_world.m == b.to_world.m; }
bool same_place(const Curves& a, const Curves& b) { return a.points == b.points; }
bool same_place(const ShapeGeometry& a, const ShapeGeometry& b) {
    return std::visit([&](const auto& one) { return same_place(one, std::get<std::decay_t<decltype(one)>>(b)); }, a);
}
bool same_place(const BareLight& a, const BareLight& b) {
    return std::visit(
        [&]<IsLight L>(const L& one) {
            if constexpr (IsNear<L>) return one.stands_as(std::get<L>(b));
            return true;
        },
        a);
}

bool same_parts(const ShapeGeometry& a, const ShapeGeometry& b) {
    if (a.index() != b.index()) return false;
    if (std::holds_alternative<Curves>(a)) return same_place(a, b);  // they stand still
    const auto *mesh = std::get_if<Mesh>(&a), *other = std::get_if<Mesh>(&b);
    return !mesh || (mesh->positions.size() == other->positions.size() &&
                     mesh->normals.size() == other->normals.size() && mesh->triangles == other->triangles);
}

void take_shape(const SceneData& first, std::uint32_t i, ShapeGeometry& there, Moment& moment) {
    const ShapeGeometry& here = first.shapes[i].geometry;
    if (!same_parts(here, there))
        moment.other_shapes.push_back(i);
    else if (!same_place(here, there))
        moment.shapes.emplace(i, positions_of(std::move(there)));
}

void take_cameras(const SceneData& there, Moment& moment) {
    moment.cameras.push_back(there.camera);
    for (const auto& one : there.cameras) moment.cameras.push_back(one.camera);
}

// Straight ways.

double between(double a, double b, double part) { return a + (b - a) * part; }
float between(float a, float b, double part) { return float(between(double{a}, double{b}, part)); }
Vec3 between(Vec3 a, Vec3 b, double part) {
    return {between(a.x, b.x, part), between(a.y, b.y, part), between(a.z, b.z, part)};
}
Rgb between(Rgb a, Rgb b, double part) {
    return {between(a.r, b.r, part), between(a.g, b.g, part), between(a.b, b.b, part)};
}
void go(std::vector<Vec3>& from, const std::vector<Vec3>& to, double part) {
    for (std::size_t i = 0; i < from.size(); ++i) from[i] = between(from[i], to[i], part);
}
void go(Matrix& from, const Matrix& to, double part) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) from.m[i][j] = between(from.m[i][j], to.m[i][j], part);
}
void go(Mesh& from, const Mesh& to, double part) {
    go(from.positions, to.positions, part);
    go(from.normals, to.normals, part);
}
void go(Sphere& from, const Sphere& to, double part) {
    from.center = between(from.center, to.center, part);
    from.radius = between(from.radius, to.radius, part);
    if (part > 0.5) from.to_world = to.to_world;
}
void go(Quadric& from, const Quadric& to, double part) { go(from.to_world, to.to_world, part); }
void go(Curves&, const Curves&, double) {}  // they stand still
void go(ShapeGeometry& from, const ShapeGeometry& to, double part) {
    std::visit([&](auto& one) { go(one, std::get<std::decay_t<decltype(one)>>(to), part); }, from);
}
// Which way one points is as at the nearer end.
template <IsLight L>
void go(L& from, const L& to, double part) {
    if constexpr (IsNear<L>) {
        L there = part > 0.5 ? to : from;
        there.position = between(from.position, to.position, part);
        L last = to;
        there.strength() = between(from.strength(), last.strength(), part);
        from = std::move(there);
    }
}
void go(BareLight& from, const BareLight& to, double part) {
    std::visit([&](auto& one) { go(one, std::get<std::decay_t<decltype(one)>>(to), part); }, from);
}
void go(CameraData& from, const CameraData& to, double part) {
    go(from.to_world, to.to_world, part);
    from.fov = between(from.fov, to.fov, part);
    from.lens_radius = between(from.lens_radius, to.lens_radius, part);
    from.focus_distance = between(from.focus_distance, to.focus_distance, part);
}

template <class State>
std::vector<Moved<State>> one_step(std::map<std::uint32_t, State>& there) {
    std::vector<Moved<State>> all;
    for (auto& [i, state] : there) all.push_back({i, {std::move(state)}});
    return all;
}

}  // namespace

ShapeGeometry positions_of(ShapeGeometry shape) {
    auto* mesh = std::get_if<Mesh>(&shape);
    if (!mesh) return shape;
    Mesh moved;
    moved.positions = std::move(mesh->positions);
    moved.normals = std::move(mesh->normals);
    return moved;
}

Moment moment_of(SceneData there, const SceneData& first) {
    Moment moment;
    const bool same_cameras = there.cameras.size() == first.cameras.size();
    if (same_cameras) take_cameras(there, moment);
    moment.has_other_things = !same_cameras || there.shapes.size() != first.shapes.size() ||
                              there.instances.size() != first.instances.size() ||
                              there.lights.size() != first.lights.size();
    if (moment.has_other_things) return moment;
    for (std::uint32_t i = 0; i < there.shapes.size(); ++i) take_shape(first, i, there.shapes[i].geometry, moment);
    for (std::uint32_t i = 0; i < there.instances.size(); ++i)
        if (there.instances[i].object == first.instances[i].object &&
            there.instances[i].to_world.m != first.instances[i].to_world.m)
            moment.instances.emplace(i, there.instances[i].to_world);
    for (std::uint32_t i = 0; i < there.lights.size(); ++i)
        if (there.lights[i].index() == first.lights[i].index() && !same_place(first.lights[i], there.lights[i]))
            moment.lights.emplace(i, there.lights[i]);
    return moment;
}

SceneData on_the_way(const SceneData& first, const Moment& there, double part) {
    SceneData scene = first;
    for (const auto& [i, shape] : there.shapes) go(scene.shapes[i].geometry, shape, part);
    for (const auto& [i, to_world] : there.instances) go(scene.instances[i].to_world, to_world, part);
    for (const auto& [i, light] : there.lights) go(scene.lights[i], light, part);
    for (std::size_t i = 0; i < there.cameras.size(); ++i)
        go(i == 0 ? scene.camera : scene.cameras[i - 1].camera, there.cameras[i], part);
    return scene;
}

void set_next_frame(SceneData& scene, SceneData there) {
    NextFrame& next = scene.next.emplace();
    next.seen_by = {there.camera, there.camera_given, there.film};
    next.cameras = there.cameras;
    Moment moment = moment_of(std::move(there), scene);
    next.motion.shapes = one_step(moment.shapes);
    next.motion.instances = one_step(moment.instances);
}

}  // namespace lightnet
