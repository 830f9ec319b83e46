// Measures of how far one picture is from another.
#pragma once

#include <cstdint>
#include <span>

#include "core/film/picture.hpp"

namespace lightnet {

/// What compare() finds. Means are over all pixels and channels, in double precision.
struct Difference {
    bool identical = false;              // the same bits in every pixel
    Rgb mean_ratio;                      // mean of the picture / mean of the reference, per channel; 1 where both are 0
    double mean_square = 0;              // d²
    double relative_square = 0;          // d² / (reference² + 0.01)
    double relative_square_trimmed = 0;  // the same without the worst 0.1 % of the pixels
    double block_difference = 0;         // mean |d| / reference over 16×16 pixel blocks of luminance
};

/// Compares colours, row by row, of two pictures of one size.
Difference compare(std::uint32_t width, std::span<const Rgb> reference, std::span<const Rgb> picture);

/// Throws Error when the sizes differ.
void refuse_other_size(const Picture& reference, const Picture& picture);

/// Compares the beauty. Throws Error when the sizes differ.
Difference compare(const Picture& reference, const Picture& picture);

}  // namespace lightnet
