// Fireflies of a picture: few pixels that hold much of its noise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/film/picture.hpp"

namespace lightnet {

/// How many pixels hold how much of what the others tell of the error, and where the brightest of them are. A value.
struct Fireflies {
    struct Place {
        std::uint32_t x = 0, y = 0;  // in the whole picture
    };
    static constexpr std::size_t most_places = 3;
    std::size_t pixels = 0;
    double share = 0;  // of the error: 0.99, or where that takes too many 0.6
    std::vector<Place> brightest;
};

/// None where no pixels stand out, or so many that they are no fireflies, or of fewer than 4096 pixels. Each pixel of
/// the sum of `layers` is compared with the median of the eight around it, as relative square error has it: d² /
/// (median² + .01), in luminance. What is seen of lamps stands out as well: leave those layers out. Any thread may ask.
std::optional<Fireflies> fireflies_in(const Picture& picture, const std::vector<const PictureLayer*>& layers);

/// What that comparison finds, of the same layers.
struct BesideNeighbours {
    std::vector<double> off;      // d² / (median² + .01), of those that are brighter; at the picture's edge 0
    std::vector<double> squares;  // median² + .01; at the edge that of the pixel itself
};
BesideNeighbours beside_neighbours(const Picture& picture, const std::vector<const PictureLayer*>& layers);

}  // namespace lightnet
