// One triangle of a mesh.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

struct Corners {
    Vec3 a, b, c;
};

inline Corners corners(const Mesh& mesh, std::uint32_t triangle) {
    const auto [a, b, c] = mesh.triangles[triangle];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

// Without a branch, as loops over many triangles want it.

/// Unit normal of a triangle: on the side of `towards`, if that isn't nothing; by the order of its vertices, or against
/// it, if it is.
inline Vec3 geometric_normal(const Corners& at, Vec3 towards, bool flip) {
    const Vec3 n = cross(at.b - at.a, at.c - at.a);
    const float size = length(n), side = dot(n, towards);
    const float sign = side < 0 ? -1 : 1, turned = flip ? -sign : sign;
    const Vec3 unit = n * (turned / size);
    const bool some = size > 0;
    return {some ? unit.x : 0, some ? unit.y : 0, some ? unit.z : 1};
}

/// `n` made a unit vector on the side of `normal`; that itself if it is nothing.
inline Vec3 shading_normal(Vec3 n, Vec3 normal) {
    const float size = length(n);
    const Vec3 unit = n * (dot(n, normal) < 0 ? -1 / size : 1 / size);
    const bool some = size > 0;
    return {some ? unit.x : normal.x, some ? unit.y : normal.y, some ? unit.z : normal.z};
}

/// Unit normal of a triangle, on the side of the mesh's shading normals; without them by the order of its vertices.
inline Vec3 geometric_normal(const Mesh& mesh, std::uint32_t triangle, const Corners& at) {
    if (mesh.normals.empty()) return geometric_normal(at, {}, mesh.flip_normals);
    const auto [i, j, k] = mesh.triangles[triangle];
    return geometric_normal(at, mesh.normals[i] + mesh.normals[j] + mesh.normals[k], false);
}

/// A point of a triangle by its weights.
inline Vec3 on_triangle(const Corners& at, float u, float v) { return at.a * (1 - u - v) + at.b * u + at.c * v; }

}  // namespace lightnet
