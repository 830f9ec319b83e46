// Whether a picture can be seen in its PNG, and by which exposure it could.
#pragma once

#include <optional>

#include "core/film/picture.hpp"

namespace lightnet {

/// How bright a picture is, by the brightest channel of each pixel. Shares are of all pixels.
struct Brightness {
    double clipped = 0;  // share that is brighter than a PNG can show
    double black = 0;    // share that a PNG shows as black
    double lit = 0;      // share that is brighter than nothing at all
    float high = 0;      // 95 % of the pixels are no brighter
    float lit_high = 0;  // 90 % of those that are lit are no brighter
};

Brightness brightness_of(const Picture& picture);

/// More stops by which most of a picture can be seen that is now mostly clipped or mostly black. None: it can be seen
/// already, or no exposure helps, as next to nothing is lit.
std::optional<double> helpful_stops(const Brightness& brightness);

/// Most of it is black, and no exposure helps.
bool hardly_lit(const Brightness& brightness);

}  // namespace lightnet
