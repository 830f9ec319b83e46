// How far a picture is from another one, in numbers with a meaning.
#pragma once

#include "core/film/picture.hpp"

namespace lightnet {

/// What compare() finds. Means are over all pixels and channels, in double precision.
struct Difference {
    bool identical = false;              // the same bits in every pixel of the beauty
    Rgb mean_ratio;                      // mean of the picture / mean of the reference, per channel
    double mean_square = 0;              // d²
    double relative_square = 0;          // d² / (reference² + 0.01)
    double relative_square_trimmed = 0;  // the same without the worst 0.1 % of the pixels
    double block_difference = 0;         // mean |d| / reference over 16×16 pixel blocks of luminance
};

/// Compares the beauty. Throws Error when the sizes differ.
Difference compare(const Picture& reference, const Picture& picture);

}  // namespace lightnet
