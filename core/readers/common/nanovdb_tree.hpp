// A NanoVDB grid's tree, read with a check of each offset.
#pragma once

#include <string>

#include "core/base/error.hpp"
#include "core/readers/common/checked_bytes.hpp"
#include "core/readers/common/sparse_grid.hpp"

namespace lightnet::nanovdb {

[[noreturn]] inline void refuse(const std::string& what) { throw Error(what); }

using Checked = CheckedBytes;

/// The tree of a grid of floats.
SparseGrid tree_in(const Checked& grid);

}  // namespace lightnet::nanovdb
