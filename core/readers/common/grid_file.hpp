// Grids in space, as NanoVDB or OpenVDB stores them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/readers/common/sparse_grid.hpp"

namespace lightnet {

/// The names of a file's grids, in order; of which kind it is its first bytes tell. Throws Error, without a file name,
/// where it is not sound.
std::vector<std::string> names_of_grids(std::span<const std::byte> bytes);
/// The first grid of that name; none: there is none. Throws Error as above.
std::optional<SparseGrid> read_grid(std::span<const std::byte> bytes, std::string_view name);

}  // namespace lightnet
