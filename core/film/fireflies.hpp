// Fireflies of a picture: few pixels that hold nearly all of its noise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/film/picture.hpp"

namespace lightnet {

/// How many pixels hold 99 % of what the others tell of the error, and where the brightest of them are. A value.
struct Fireflies {
    struct Place {
        std::uint32_t x = 0, y = 0;  // in the whole picture
    };
    static constexpr std::size_t most_places = 3;
    std::size_t pixels = 0;
    std::vector<Place> brightest;
};

/// None where no pixels stand out, or so many that they are no fireflies, or of fewer than 4096 pixels. Each pixel of
/// the sum of `layers` is compared with the median of the eight around it, as relative square error has it: d² /
/// (median² + .01), in luminance. What is seen of lamps stands out as well: leave those layers out. Any thread may ask.
std::optional<Fireflies> fireflies_in(const Picture& picture, const std::vector<const PictureLayer*>& layers);

}  // namespace lightnet
