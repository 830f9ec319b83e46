// Takes noise out of finished pictures, whose layers still add up.
#pragma once

#include <string>
#include <vector>

#include "core/film/picture.hpp"

namespace lightnet {

/// A picture without most of its noise, and what is to be said of it.
struct Cleaned {
    Picture picture;
    std::vector<std::string> lacks;  // what would have made it better, one sentence each
};

/// How much time is taken: by a draft, centres are twice as far from each other as usually, which takes a third less
/// time; at best, twice as near, which takes three times as long.
enum class CleanQuality { draft, usual, best };

/// The note of a cleaned picture, an attribute of its file: what was done.
inline constexpr const char* cleaned_note = "cleaned";

/// The layer beside the sum that says how far the sum without gains is expected to be off.
inline constexpr const char* clean_error = "clean_error";

/// Filters all layers with the same weights. These come from the sum of the layers without gains and from features of
/// what is seen, never from gains: remixing what is cleaned gives the same bits as cleaning what is remixed, and the
/// beauty is the sum of the layers as ever. Mattes, alpha, notes and what is shown beside the sum are kept; halves and
/// features are left out, "clean_error" is added: how much the sum without gains is expected to be off by around a
/// pixel, in parts of the root of value² + 0.01 (root mean square; where the samples are in two halves).
///
/// Of each half of the samples first-order regressions on features are made, by weights of non-local means from the
/// other half (Bitterli et al. 2016), around centres some pixels apart; a pixel's value is the weighted mean of what
/// the planes around it say (Moon et al. 2015, "Adaptive Rendering with Linear Predictions"). That is done with strict
/// and with lax weights. Which of them, or of nothing at all, is taken where is decided by how far each is from the
/// other half (Rousselle et al. 2012), smoothed.
///
/// On all cores, with the same bytes on any number of them, and on any machine. A crop is cleaned by what is in it. The
/// picture is cleaned in place: beside it there are some 140 bytes for each pixel, whatever the number of layers.
Cleaned clean(Picture picture, CleanQuality quality = CleanQuality::usual);

}  // namespace lightnet
