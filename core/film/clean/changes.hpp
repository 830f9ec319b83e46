// Changes of colours by regressions.
#pragma once

#include <array>

#include "core/film/clean/regression.hpp"
#include "core/film/clean/window.hpp"

namespace lightnet::cleaning {

/// Where changes of one half by one filter go; null: they are not wanted. `scale`: by so much for each pixel of the
/// area, laid out as a channel is; null: by 1.
struct WantedChanges {
    AreaChannels* changes = nullptr;
    const float* scale = nullptr;
    float part = 1;  // by so much for all of them
};
using Wanted = std::array<std::array<WantedChanges, filters>, 2>;  // by half and filter

/// Fits planes over the features to the colours of both halves, and adds by how much they differ from the colours of
/// the window, times weight and scale. All channels have the same weights, so it is linear in the colours, and where
/// all are alike it is exactly 0. `area`: where that begins in the picture.
void add_changes(const Guide& guide, const Centre& centre, const Regressions& regressions,
                 const std::array<AreaChannels, 2>& values, Place area, const Wanted& wanted);

/// Adds a part of the weights of the window to those of its pixels, laid out as a channel is.
void add_weights(const Centre& centre, const Regression& regression, float part, Place area, float* sums);

}  // namespace lightnet::cleaning
