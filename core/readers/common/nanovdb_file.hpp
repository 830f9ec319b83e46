// Grids in space as NanoVDB stores them: files that end with .nvdb.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math/transform.hpp"
#include "core/scene/media/medium.hpp"

namespace lightnet {

/// Floats at points of space, in blocks, 0 where the file has none; what is below 0 there is 0.
struct NanovdbGrid {
    std::shared_ptr<const VolumeGrid> grid;
    Matrix to_grid;  // from the file's world to the grid's unit cube
};

/// The names of a file's grids, in order. Throws Error, without a file name, where it is not sound.
std::vector<std::string> names_in_nanovdb(std::span<const std::byte> bytes);
/// The first grid of that name; none: there is none. Nothing of the file is believed: each offset is checked, and what
/// the grid takes is in proportion to the file. Throws Error as above.
/// DECISIONS: nanovdb-read-by-ourselves
std::optional<NanovdbGrid> read_nanovdb(std::span<const std::byte> bytes, std::string_view name);

}  // namespace lightnet
