// Meshes that KHR_draco_mesh_compression has packed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/readers/gltf/document.hpp"

namespace lightnet::gltf {

/// A mesh as it came out.
struct Unpacked {
    std::vector<std::uint32_t> corners;          // of triangles
    std::map<std::uint64_t, Values> attributes;  // by their ids; whole numbers as they are
};

/// None: reported at `where`. It may have so many triangles at most as `most` says.
std::optional<Unpacked> unpack_mesh(const At& where, std::span<const std::byte> bytes, std::uint64_t most);

}  // namespace lightnet::gltf
