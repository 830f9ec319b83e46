// Weights of pairs of pixels by how alike they are, for a strip of pixels at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/film/clean/guide.hpp"
#include "core/film/clean/sheet.hpp"

namespace lightnet::cleaning {

/// How far a pixel is from another.
struct Offset {
    std::int32_t x = 0, y = 0;
};

/// Whom each pixel is compared with: all in a disc of that radius. Every second one would do for the noise, but what
/// little a firefly leaves would be a grid of dots.
const std::vector<Offset>& offsets();

/// Rows of an area that are done at once.
inline constexpr std::uint32_t strip_rows = 8;
inline constexpr std::size_t strip_pixels = std::size_t{strip_rows} * area_side;

/// Several filters differ in how much of a difference they take for noise: by this part of the noise's deviation.
inline constexpr std::size_t filters = 2;
inline constexpr std::array<float, filters> tolerance{0.6f, 1.5f};

/// Weights of non-local means (Buades et al. 2005, with noise taken into account as by Rousselle et al. 2012, eq. 4),
/// by filter, offset and pixel. Scratch of one thread.
class PairWeights {
public:
    PairWeights();
    /// For a strip that begins at `place`, by the colours of that half. Those beyond the picture have none.
    void make(const Guide& guide, std::size_t half, Place place);
    /// Of `strip_pixels` pixels, row by row.
    const float* of(std::size_t filter, std::size_t offset) const {
        return weights_.data() + (filter * offsets().size() + offset) * strip_pixels;
    }

private:
    std::vector<float> weights_;
};

}  // namespace lightnet::cleaning
