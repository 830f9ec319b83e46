// One triangle of a mesh.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/scene/scene_data.hpp"

namespace lightnet {

struct Corners {
    Vec3 a, b, c;
};

inline Corners corners(const Mesh& mesh, std::uint32_t triangle) {
    const auto [a, b, c] = mesh.triangles[triangle];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

/// Unit normal of a triangle, on the side of the mesh's shading normals; without them by the order of its vertices.
inline Vec3 geometric_normal(const Mesh& mesh, std::uint32_t triangle, const Corners& at) {
    const Vec3 n = cross(at.b - at.a, at.c - at.a);
    const float size = length(n);
    if (!(size > 0)) return {0, 0, 1};
    bool flip = mesh.flip_normals;
    if (!mesh.normals.empty()) {
        const auto [i, j, k] = mesh.triangles[triangle];
        flip = dot(n, mesh.normals[i] + mesh.normals[j] + mesh.normals[k]) < 0;
    }
    return n * ((flip ? -1 : 1) / size);
}

}  // namespace lightnet
