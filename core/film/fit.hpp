// Gains that bring a picture near another one.
#pragma once

#include <vector>

#include "core/film/gains.hpp"
#include "core/film/picture.hpp"

namespace lightnet {

/// The gains, 0 or more, with which the layers' sum has the least square distance to `target`'s beauty: one for each
/// layer and channel, or with `grey` one for each layer. Exact, as light is linear: non-negative least squares (Lawson
/// & Hanson 1974, "Solving Least Squares Problems", chapter 23). Pixels that are not finite in either don't count;
/// where layers can't be told apart, the first of them counts. Throws Error when the sizes differ.
std::vector<Gain> fit(const Picture& picture, const Picture& target, bool grey);

}  // namespace lightnet
