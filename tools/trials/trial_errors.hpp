// Errors of pictures of trials, without a reference: beside two by path tracing.
#pragma once

#include <array>
#include <vector>

#include "core/film/picture.hpp"

namespace lightnet {

/// Of one way to light a scene, with two seeds.
using PicturePair = std::array<Picture, 2>;

/// Means over pixels and channels of d² / (light² + 0.01), where the light is that of all pictures together, around the
/// pixel.
struct TrialErrors {
    double own = 0;     // what a pixel's neighbours don't share: noise of its samples
    double shared = 0;  // what blocks of 8 × 8 pixels share: noise of records and photons, and bias
};

/// Of one picture of the pair, which has no bias and is all that is known of the truth; its neighbours share nothing.
/// Then of each of `singles`: how far it is from the pair's mean, less the noise of that, without the thousandth of the
/// pixels where that has most: fireflies count against who has them. An error of less than a fiftieth of the pair's
/// can't be told, and counts as that.
std::vector<TrialErrors> errors_of(const PicturePair& pair, const std::vector<Picture>& singles);

}  // namespace lightnet
