// One number per pixel, and filters over it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lightnet {

/// Row by row, row 0 on top.
struct Plane {
    std::uint32_t width = 0, height = 0;
    std::vector<float> values;
};

/// The weights of a filter along one axis: 2r + 1 of them, the middle one for the pixel itself.
using Weights = std::vector<double>;

/// Weighs each pixel's neighbours along its row by `across` and then along its column by `down`. Beyond the edges the
/// outermost pixels go on.
Plane filtered(const Plane& plane, std::span<const double> across, std::span<const double> down);

/// a exp(-s x²) for whole x from -radius to radius, s being `sharpness`; adds up to 1.
Weights gaussian(double sharpness, int radius);

}  // namespace lightnet
