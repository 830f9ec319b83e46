// Meshes in the PLY format: ASCII and binary of both byte orders.
#pragma once

#include <cstddef>
#include <span>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// The mesh of a PLY file: positions, normals (nx ny nz), texture coordinates (u v, s t and their like) and colours
/// (red green blue) per vertex; faces of three or more corners, cut into triangles like a fan, and triangle strips.
/// Other properties and elements are skipped. Throws Error (without a file name) when the bytes are no sound PLY file;
/// allocates no more than a small multiple of them.
Mesh read_ply(std::span<const std::byte> bytes);

}  // namespace lightnet
