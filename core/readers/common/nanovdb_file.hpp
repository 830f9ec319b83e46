// Grids in space as NanoVDB stores them: files that end with .nvdb.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/readers/common/sparse_grid.hpp"

namespace lightnet {

/// The names of a file's grids, in order. Throws Error, without a file name, where it is not sound.
std::vector<std::string> names_in_nanovdb(std::span<const std::byte> bytes);
/// The first grid of that name; none: there is none. Nothing of the file is believed: each offset is checked, and what
/// the grid takes is in proportion to the file. Throws Error as above.
/// DECISIONS: nanovdb-read-by-ourselves
std::optional<SparseGrid> read_nanovdb(std::span<const std::byte> bytes, std::string_view name);

}  // namespace lightnet
