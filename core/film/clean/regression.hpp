// First-order regressions around centres: planes over features, fitted to what is alike.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/film/clean/guide.hpp"
#include "core/film/clean/window.hpp"

namespace lightnet::cleaning {

/// Several filters differ in how much of a difference they take for noise: by this part of the noise's deviation.
inline constexpr std::size_t filters = 2;
inline constexpr std::array<float, filters> tolerance{0.7f, 3.5f};

/// Of a plane: a constant, and slopes along features.
inline constexpr std::size_t most_unknowns = most_features + 1;

/// Where a plane is fitted, and over which features: those that vary around there.
struct Centre {
    Place at;  // in the picture
    std::uint8_t features = 0;
    std::array<std::uint8_t, most_features> which{};
    std::size_t unknowns() const { return std::size_t{features} + 1; }
};

/// A regression around a centre, of whatever colours.
struct Regression {
    Cells weights;                                                        // of non-local means
    std::array<std::array<float, most_unknowns>, most_unknowns> inverse;  // of the matrix of moments
};
using Regressions = std::array<std::array<Regression, filters>, 2>;  // by half and filter

/// Features less those of the centre, over its window; the first of `planes`, which would be 1, is left out.
using Planes = std::array<Cells, most_unknowns>;
[[gnu::always_inline]] inline void plane_of(const Feature& feature, Place centre, Cells& plane) {
    const float here = *feature.value.at(centre.x, centre.y);
    const float* const corner = corner_of(feature.value, centre);
    for (std::size_t k = 0; k < window_vectors; ++k)
        plane[k] = eight_at(corner + offset_of(k, feature.value.stride())) - here;
}

/// Makes the regressions around a centre, whose place is given. The weights for one half of the samples come from the
/// other: non-local means (Buades et al. 2005, with noise taken into account as by Rousselle et al. 2012, eq. 4) of
/// means of 3 x 3 pixels. Slopes along features that vary by no more than their noise are held small (Bitterli et al.
/// 2016, "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo Renderings").
void regress(const Guide& guide, Centre& centre, Regressions& regressions);

}  // namespace lightnet::cleaning
