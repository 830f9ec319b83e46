// The window around a centre of regression, as vectors.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/math/eight.hpp"
#include "core/film/clean/sheet.hpp"

namespace lightnet::cleaning {

inline constexpr std::size_t row_vectors = 2, window_rows = 2 * reach + 1, window_vectors = row_vectors * window_rows;
static_assert(window_rows <= 8 * row_vectors, "a row of the window fits");

/// A number for each place of the window, row by row; those at the end of a row, where vectors are longer, count for
/// nothing. Processors with narrow vectors would not align it for wide ones.
struct alignas(64) Cells {
    std::array<Eight, window_vectors> all;
    Eight& operator[](std::size_t k) { return all[k]; }
    const Eight& operator[](std::size_t k) const { return all[k]; }
};

/// Where vector `k` of the window is, in numbers from its upper left one; `stride`: from row to row.
[[gnu::always_inline]] inline std::size_t offset_of(std::size_t k, std::size_t stride) {
    return k / row_vectors * stride + k % row_vectors * 8;
}

/// The upper left number of the window around a pixel of a sheet.
[[gnu::always_inline]] inline const float* corner_of(const Sheet& sheet, Place centre) {
    return sheet.at(centre.x - std::int64_t{reach}, centre.y - std::int64_t{reach});
}

/// Three channels of the pixels of an area, and of those around it that its regressions see.
class AreaChannels {
public:
    static constexpr std::size_t stride = area_side + 2 * halo, size = stride * stride;
    AreaChannels() : values_(3 * size) {}
    float* of(std::size_t channel) { return values_.data() + channel * size; }
    const float* of(std::size_t channel) const { return values_.data() + channel * size; }
    void blacken() { std::fill(values_.begin(), values_.end(), 0.0f); }
    /// Coordinates from the area's upper left pixel.
    static std::size_t index(std::int64_t x, std::int64_t y) {
        return static_cast<std::size_t>(y + halo) * stride + static_cast<std::size_t>(x + halo);
    }

private:
    std::vector<float> values_;
};

}  // namespace lightnet::cleaning
