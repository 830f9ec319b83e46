#include "core/scene/surfaces/moving_shape.hpp"

#include "core/base/math/transform.hpp"
#include "core/scene/shapes/offset.hpp"

#include <algorithm>
#include <vector>

namespace lightnet {
namespace {

Corners corners_of(const std::vector<Vec3>& values, const std::array<std::uint32_t, 3>& which) {
    const auto [a, b, c] = which;
    return {values[a], values[b], values[c]};
}

Corners between(const StepPlace& place, const Corners& before, const Corners& after) {
    return {place.between(before.a, after.a), place.between(before.b, after.b), place.between(before.c, after.c)};
}

Matrix between(const StepPlace& place, const Matrix& before, const Matrix& after) {
    const double part = double{place.part};
    Matrix m;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) m.m[i][j] = (1 - part) * before.m[i][j] + part * after.m[i][j];
    return m;
}

}  // namespace

Corners MovingShape::corners(std::uint32_t triangle, ShutterTime time) const {
    const StepPlace place(steps(), time);
    const auto at = [&](std::size_t step) {
        return corners_of(std::get<Mesh>(at_step(step)).positions, std::get<Mesh>(first_).triangles[triangle]);
    };
    return between(place, at(place.step), at(place.step + 1));
}

Corners MovingShape::normals(std::uint32_t triangle, ShutterTime time) const {
    const Mesh& mesh = std::get<Mesh>(first_);
    if (mesh.normals.empty()) return {};
    const StepPlace place(steps(), time);
    const auto at = [&](std::size_t step) {
        return corners_of(std::get<Mesh>(at_step(step)).normals, mesh.triangles[triangle]);
    };
    return between(place, at(place.step), at(place.step + 1));
}

Sphere MovingShape::sphere(float open) const {
    const StepPlace place(steps(), open);
    const Sphere &before = std::get<Sphere>(at_step(place.step)), &after = std::get<Sphere>(at_step(place.step + 1));
    Sphere sphere = before;
    sphere.center = place.between(before.center, after.center);
    sphere.radius = place.between(before.radius, after.radius);
    sphere.to_world = between(place, before.to_world, after.to_world);
    return sphere;
}

Quadric MovingShape::quadric(float open) const {
    const StepPlace place(steps(), open);
    const Quadric &before = std::get<Quadric>(at_step(place.step)), &after = std::get<Quadric>(at_step(place.step + 1));
    Quadric quadric = before;
    quadric.to_world = between(place, before.to_world, after.to_world);
    return quadric;
}

Box MovingShape::bounds() const {
    Box box;
    const auto* mesh = std::get_if<Mesh>(&first_);
    for (std::size_t step = 0; step < steps(); ++step) {
        if (!mesh) add_to(box, at_step(step), Matrix{});
        for (std::size_t t = 0; mesh && t < mesh->triangles.size(); ++t)
            for (const auto vertex : mesh->triangles[t]) box.add(std::get<Mesh>(at_step(step)).positions[vertex]);
    }
    return box;
}

float MovingShape::rounding() const {
    const Box box = bounds();
    return 4 * rounding_step * std::max(largest_coordinate(box.low), largest_coordinate(box.high));
}

}  // namespace lightnet
