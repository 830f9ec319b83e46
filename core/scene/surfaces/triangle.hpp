// One triangle of a mesh.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/math/wide_vec.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

struct Corners {
    Vec3 a, b, c;
};

inline Corners corners(const Mesh& mesh, std::uint32_t triangle) {
    const auto [a, b, c] = mesh.triangles[triangle];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

// Without a branch, as loops over many triangles want it.

/// By the order of the corners; as long as twice the triangle is large. In double: in single precision slivers would be
/// turned, and what is larger than some 4e9 metres would have none.
inline WideVec3 wide_normal(const Corners& at) {
    const WideVec3 a(at.a);
    return cross(WideVec3(at.b) - a, WideVec3(at.c) - a);
}
inline float area_of(const Corners& at) { return float(0.5 * length(wide_normal(at))); }

/// Unit normal of a triangle: on the side of `towards`, if that isn't nothing; by the order of its vertices, or against
/// it, if it is.
inline Vec3 geometric_normal(const Corners& at, Vec3 towards, bool flip) {
    const WideVec3 n = wide_normal(at);
    const double size = length(n), side = dot(n, WideVec3(towards));
    const double sign = side < 0 ? -1 : 1, turned = flip ? -sign : sign;
    const Vec3 unit = (n * (turned / size)).rounded();
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

/// Of what the corners have, such as normals, by a point's weights.
inline Vec3 between_corners(const Corners& of, float u, float v) { return of.a * (1 - u - v) + of.b * u + of.c * v; }

/// A point of a triangle by its weights: the nearest to it that there is in single precision.
inline Vec3 on_triangle(const Corners& at, float u, float v) {
    const WideVec3 a(at.a);
    return (a + (WideVec3(at.b) - a) * double{u} + (WideVec3(at.c) - a) * double{v}).rounded();
}

/// What rays round when they look for a triangle whose edges are no longer: own part of an offset.
inline float triangle_offset(float longest_edge) { return 8 * rounding_step * longest_edge; }

/// Because of one triangle: where one of its angles is nearly straight, rays turn it about its longest edge, as far as
/// the circle through its corners is wider than that.
inline float turned_offset(const Corners& at) {
    const WideVec3 a(at.a), ab = WideVec3(at.b) - a, ac = WideVec3(at.c) - a, bc = ac - ab;
    const double size = length(cross(ab, ac)), edges = std::sqrt(dot(ab, ab) * dot(ac, ac) * dot(bc, bc));
    return triangle_offset(float(edges / size));
}

/// By how much rays must leave a triangle at `position`. `turned`: its turned_offset(), or 0 where that is no more than
/// `least`: what its mesh asks for.
inline float triangle_offset_at(float turned, Vec3 position, Vec3 normal, float least) {
    const float most = 0x1p-16f * largest_coordinate(position);
    const float no_more = turned < most ? turned : most;  // of what is hardly there
    return offset_at(position, normal, no_more > least ? no_more : least);
}

}  // namespace lightnet
