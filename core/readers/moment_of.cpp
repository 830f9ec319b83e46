#include "core/readers/moment_of.hpp"

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/base/math/shutter.hpp"
#include "core/readers/common/between_transforms.hpp"
#include "core/scene/surfaces/moving_shape.hpp"

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

/// Readers order corners by shading normals, so what bends a lot may turn its corners round: it keeps its first order.
bool same_corners(const Mesh& a, const Mesh& b) {
    return std::ranges::equal(a.triangles, b.triangles, [](const auto& one, const auto& other) {
        return one[0] == other[0] &&
               ((one[1] == other[1] && one[2] == other[2]) || (one[1] == other[2] && one[2] == other[1]));
    });
}

bool same_parts(const ShapeGeometry& a, const ShapeGeometry& b) {
    if (a.index() != b.index()) return false;
    if (std::holds_alternative<Curves>(a)) return same_place(a, b);  // they stand still
    const auto *mesh = std::get_if<Mesh>(&a), *other = std::get_if<Mesh>(&b);
    return !mesh || (mesh->positions.size() == other->positions.size() &&
                     mesh->normals.size() == other->normals.size() && same_corners(*mesh, *other));
}

void take_shape(const SceneData& first, std::uint32_t i, ShapeGeometry& there, Moment& moment) {
    const ShapeGeometry& here = first.shapes[i].geometry;
    if (!same_parts(here, there))
        moment.other_shapes.push_back(i);
    else if (!same_place(here, there))
        moment.shapes.emplace(i, positions_of(std::move(there)));
}

bool same_look(const Texture& a, const Texture& b) {
    const auto *image = std::get_if<ImageTexture>(&a.pattern), *other = std::get_if<ImageTexture>(&b.pattern);
    return a.scale == b.scale && (!image || !other || image->uv == other->uv);
}
bool same_look(const Shape& a, const Shape& b) {
    return a.emission.has_value() == b.emission.has_value() &&
           (!a.emission || a.emission->radiance == b.emission->radiance);
}
bool same_look(const BareLight& a, const BareLight& b) {
    const auto *sun = std::get_if<DirectionalLight>(&a), *other = std::get_if<DirectionalLight>(&b);
    return !sun || !other || (sun->direction == other->direction && sun->irradiance == other->irradiance);
}
bool same_look(const SceneData& a, const SceneData& b) {
    const auto same = [](const auto& one, const auto& there) {
        return std::ranges::equal(one, there, [](const auto& x, const auto& y) { return same_look(x, y); });
    };
    return same(a.textures, b.textures) && same(a.shapes, b.shapes) && same(a.lights, b.lights);
}

void take_cameras(const SceneData& there, Moment& moment) {
    moment.cameras.push_back(there.camera);
    for (const auto& one : there.cameras) moment.cameras.push_back(one.camera);
}

// Straight ways, as MovingShape goes them.

void go(std::vector<Vec3>& from, const std::vector<Vec3>& to, const StepPlace& place) {
    for (std::size_t i = 0; i < from.size(); ++i) from[i] = place.between(from[i], to[i]);
}
ShapeGeometry on_way(Mesh from, const ShapeGeometry& to, const StepPlace& place) {
    go(from.positions, std::get<Mesh>(to).positions, place);
    go(from.normals, std::get<Mesh>(to).normals, place);
    return from;
}
ShapeGeometry on_way(const Sphere& from, const ShapeGeometry& to, const StepPlace& place) {
    return MovingShape(from, std::span(&to, 1)).sphere(place.part);
}
ShapeGeometry on_way(const Quadric& from, const ShapeGeometry& to, const StepPlace& place) {
    return MovingShape(from, std::span(&to, 1)).quadric(place.part);
}
ShapeGeometry on_way(const Curves& from, const ShapeGeometry&, const StepPlace&) { return from; }  // they stand still

// Which way one points is as at the nearer end.
void go(BareLight& from, const BareLight& to, const StepPlace& place) {
    std::visit(
        [&]<IsLight L>(L& one) {
            if constexpr (IsNear<L>) {
                L last = std::get<L>(to), there = place.part > 0.5f ? last : one;
                there.position = place.between(one.position, last.position);
                there.strength() = place.between(one.strength(), last.strength());
                one = std::move(there);
            }
        },
        from);
}
void go(CameraData& from, const CameraData& to, const StepPlace& place) {
    from.to_world = between(from.to_world, to.to_world, double{place.part});
    from.fov = place.between(from.fov, to.fov);
    from.lens_radius = place.between(from.lens_radius, to.lens_radius);
    from.focus_distance = place.between(from.focus_distance, to.focus_distance);
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
    moment.looks_otherwise = !same_look(first, there);
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
    const StepPlace place(2, float(part));
    SceneData scene = first;
    for (const auto& [i, shape] : there.shapes) {
        auto& geometry = scene.shapes[i].geometry;
        geometry = std::visit([&, &to = shape](auto& one) { return on_way(std::move(one), to, place); }, geometry);
    }
    for (const auto& [i, to_world] : there.instances)
        scene.instances[i].to_world = between(scene.instances[i].to_world, to_world, part);
    for (const auto& [i, light] : there.lights) go(scene.lights[i], light, place);
    for (std::size_t i = 0; i < there.cameras.size(); ++i)
        go(i == 0 ? scene.camera : scene.cameras[i - 1].camera, there.cameras[i], place);
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
