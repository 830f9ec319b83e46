// Files of NanoVDB, made of a few points.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lightnet::test {

/// A grid of floats: what it has at its active points; 0 elsewhere. Others may be damaged by whoever wants that.
struct NanovdbPoints {
    std::string name = "density";
    std::map<std::array<std::int32_t, 3>, float> points{};
    double step = 1;                        // metres between points
    std::array<double, 3> origin{0, 0, 0};  // of the point (0, 0, 0), metres
    std::uint32_t type = 1, kind = 2;       // floats, fog
};

/// The bytes of one grid.
std::string nanovdb_grid(const NanovdbPoints& grid);
/// A file of several. `codec`: 0 plain, 1 packed by zlib, 2 by Blosc.
std::string nanovdb_file(const std::vector<NanovdbPoints>& grids, std::uint16_t codec = 0);

}  // namespace lightnet::test
