// Small meshes as packers of meshes write them.
#pragma once

#include <cstdint>
#include <string>

namespace lightnet::test {

/// A strip of quads by Draco: positions (id 0) and colours (id 1), red, and yellow where y is 1. `by_edges`: as it
/// packs best; else in the order of its triangles.
std::string packed_by_draco(std::uint32_t quads, bool by_edges);

/// A view of a buffer, packed by meshopt.
struct PackedView {
    std::string bytes, mode;
    std::size_t stride = 0, count = 0;

    /// As glTF tells of it, its bytes lying there in buffer 0. `more`: members of the extension.
    std::string json(std::size_t at, const std::string& more = "") const;
};
/// The corners of the unit square.
PackedView packed_corners();
/// Its two triangles, in 16 bits.
PackedView packed_order();

}  // namespace lightnet::test
