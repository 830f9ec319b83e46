// The guide by which a picture is cleaned: its colours in two halves, their noise, and features of what is seen.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/film/clean/sheet.hpp"
#include "core/film/picture.hpp"

namespace lightnet::cleaning {

/// A number that says what is seen, such as one channel of the albedo, without its noise, and the variance of what was
/// left of that.
struct Feature {
    Sheet value, noise;
};

/// What is no number, or more than weights can be made of, counts as 0 or as the largest.
inline constexpr float largest = 1e15f;  // squares of it are numbers, too
inline float sound(float value) { return std::isfinite(value) ? std::clamp(value, -largest, largest) : 0; }

/// As many as these: albedo and normal have three each, the depth is one.
inline constexpr std::size_t most_features = 7;

/// All that weights are made from. Gains are not among it, so weights know of none. A value; read by all threads.
struct Guide {
    std::uint32_t width = 0, height = 0;
    bool halves = false;           // the samples were in two halves; else both are the whole picture
    std::array<Colours, 2> half;   // the sum of the layers, without gains
    std::array<Colours, 2> means;  // of 3 x 3 pixels of each half
    Colours variance;              // of such a mean
    std::vector<Feature> features;
    Sheet inside;  // 1 in the picture, 0 beyond
};

/// Of a picture as the film gives it; its beauty may be missing where it has layers. What is no number, or more than
/// weights can be made of, counts as 0 or as the largest. Features that are there for cleaning are used up.
Guide take_guide(Picture& picture);

}  // namespace lightnet::cleaning
