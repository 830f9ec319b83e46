// Files of OpenVDB, made of a few points.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/nanovdb_bytes.hpp"

namespace lightnet::test {

/// How a file stores its numbers. `packing`: bits, 1 zlib, 2 active ones only, 4 Blosc.
struct VdbStorage {
    std::uint32_t packing = 0;
    bool half = false;
    std::string transform = "UniformScaleTranslateMap", type = "Tree_float_5_4_3", kind = "fog volume";
};

/// A file of grids, each of one step alike in all directions.
std::string vdb_file(const std::vector<NanovdbPoints>& grids, const VdbStorage& storage = {});

}  // namespace lightnet::test
