// Prefetches of what will soon be read of meshes: of many triangles at once, so that their ways through memory
// are waited for together. Inlined always, as compilers leave out calls of functions that do nothing else.
#pragma once

#include <cstdint>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Which corners a triangle has.
[[gnu::always_inline]] inline void fetch_triangle(const Mesh& mesh, std::uint32_t triangle) {
    __builtin_prefetch(&mesh.triangles[triangle]);
}

/// Where they are, and what else is known there; when fetch_triangle() has been called a while ago.
[[gnu::always_inline]] inline void fetch_corners(const Mesh& mesh, std::uint32_t triangle) {
    for (const std::uint32_t corner : mesh.triangles[triangle]) {
        __builtin_prefetch(&mesh.positions[corner]);
        if (!mesh.normals.empty()) __builtin_prefetch(&mesh.normals[corner]);
        if (!mesh.uvs.empty()) __builtin_prefetch(&mesh.uvs[corner]);
    }
}

}  // namespace lightnet
