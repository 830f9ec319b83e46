// The choice of filters, place by place.
#pragma once

#include <array>
#include <vector>

#include "core/film/clean/regression.hpp"

namespace lightnet::cleaning {

/// What a pixel is expected to be off by, squared, in parts of value² + 0.01, over its surroundings: all of it, which
/// is known so roughly that it may be below 0, what of it is noise that was left, and how roughly the rest is known:
/// the variance of what single pixels say of it.
struct SquaredError {
    float all = 0, variance = 0, spread = 0;
};

/// What filters would change the sum of the layers by, by half and filter.
using SumChanges = std::array<std::array<AreaChannels, filters>, 2>;

/// Of the pixels of an area, row by row: for what is further from its edge than `error_radius + choice_radius`.
struct Choice {
    std::array<std::vector<float>, filters> parts;  // of each filter; what is missing from 1 is left as it is
    std::vector<SquaredError> expected;
};

/// Takes what is expected to be nearest, smoothed.
Choice choose(const Guide& guide, Place area, const SumChanges& changes);

}  // namespace lightnet::cleaning
