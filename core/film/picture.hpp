// A finished picture: what goes into files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math/rgb.hpp"

namespace lightnet {

/// One contribution to the picture.
struct PictureLayer {
    std::string name;
    std::vector<Rgb> pixels;  // row by row, row 0 on top
    friend bool operator==(const PictureLayer&, const PictureLayer&) = default;
};

/// A picture and what it is the sum of. Linear RGB with the primaries of BT.709.
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<Rgb> beauty;           // row by row, row 0 on top
    std::vector<PictureLayer> layers;  // in the order in which they add up to the beauty; may be empty
    friend bool operator==(const Picture&, const Picture&) = default;
};

/// The float32 sum of the layers, from the left to the right: beauty, exactly.
std::vector<Rgb> sum_of(const std::vector<PictureLayer>& layers);

}  // namespace lightnet
