// Grids in space as OpenVDB stores them: files that end with .vdb.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/readers/common/sparse_grid.hpp"

namespace lightnet {

/// Told by the first bytes.
bool is_vdb(std::span<const std::byte> bytes);
/// The names of a file's grids, in order. Throws Error, without a file name, where it is not sound.
std::vector<std::string> names_in_vdb(std::span<const std::byte> bytes);
/// The first grid of that name, of floats or half floats; none: there is none. What it takes is in proportion to the
/// file, of which nothing is believed. Throws Error as above.
/// DECISIONS: nanovdb-read-by-ourselves
std::optional<SparseGrid> read_vdb(std::span<const std::byte> bytes, std::string_view name);

}  // namespace lightnet
