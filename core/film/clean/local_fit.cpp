#include "core/film/clean/local_fit.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "core/base/math/columns.hpp"

namespace lightnet::cleaning {
namespace {

constexpr float damping = 0.01f;      // of a slope, in parts of the feature's variance
constexpr float least_noise = 1e-6f;  // of a feature, whose range is about 1

/// As many pixels of a row as there are lanes, with so many features.
template <std::size_t Features>
struct LaneFit {
    static constexpr std::size_t unknowns = Features + 1;

    const Guide& guide;
    const PairWeights& all_weights;
    std::size_t filter;
    const AreaValues& values;
    Place pixel;            // the first one, in the picture
    std::size_t x, y, row;  // the same, in the area; its row in the strip
    AreaResult& change;
    alignas(64) float moments[unknowns * (unknowns + 1) / 2][lanes];
    alignas(64) float kernel[unknowns][lanes];  // weight × (kernel · (1, features)) is how much a neighbour counts
    alignas(64) float off[Features + 1][lanes];
    alignas(64) float part[lanes];

    [[gnu::always_inline]] void work() {
        collect();
        solve();
        apply();
    }

private:
    const float* weights_at(std::size_t k) const { return all_weights.of(filter, k) + row * area_side + x; }

    // Is any of them not 0?
    [[gnu::always_inline]] static bool any(const float* w) {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < lanes; ++i) bits |= std::bit_cast<std::uint32_t>(w[i]);
        return bits != 0;
    }

    [[gnu::always_inline]] void differences(std::size_t k) {
        const auto [dx, dy] = offsets()[k];
        for (std::size_t f = 0; f < Features; ++f) {
            const float* const here = guide.features[f].value.at(pixel.x, pixel.y);
            const float* const there = guide.features[f].value.at(pixel.x + dx, pixel.y + dy);
            for (std::size_t i = 0; i < lanes; ++i) off[f][i] = there[i] - here[i];
        }
    }

    [[gnu::always_inline]] void collect() {
        for (auto& moment : moments) std::fill_n(moment, lanes, 0.0f);
        for (std::size_t k = 0; k < offsets().size(); ++k) {
            const float* const w = weights_at(k);
            if (!any(w)) continue;
            differences(k);
            for (std::size_t i = 0; i < lanes; ++i) moments[0][i] += w[i];
            std::size_t m = 1;
            for (std::size_t f = 0; f < Features; ++f) {
                for (std::size_t i = 0; i < lanes; ++i) part[i] = w[i] * off[f][i];
                for (std::size_t i = 0; i < lanes; ++i) moments[m][i] += part[i];
                ++m;
                for (std::size_t g = 0; g <= f; ++g, ++m)
                    for (std::size_t i = 0; i < lanes; ++i) moments[m][i] += part[i] * off[g][i];
            }
        }
    }

    // The first column of the inverse of the matrix of moments, by Cholesky's way without roots.
    [[gnu::always_inline]] void solve() {
        alignas(64) double lower[unknowns][unknowns][lanes], diagonal[unknowns][lanes], column[unknowns][lanes];
        alignas(64) double sum[lanes];
        for (std::size_t a = 0, m = 0; a < unknowns; ++a)
            for (std::size_t b = 0; b <= a; ++b, ++m) {
                for (std::size_t i = 0; i < lanes; ++i) sum[i] = moments[m][i];
                if (a == b && a > 0) damp(a - 1, sum);
                for (std::size_t k = 0; k < b; ++k)
                    for (std::size_t i = 0; i < lanes; ++i) sum[i] -= lower[a][k][i] * lower[b][k][i] * diagonal[k][i];
                if (a == b)
                    for (std::size_t i = 0; i < lanes; ++i) diagonal[a][i] = sum[i] > 1e-30 ? sum[i] : 1e-30;
                else
                    for (std::size_t i = 0; i < lanes; ++i) lower[a][b][i] = sum[i] / diagonal[b][i];
            }
        for (std::size_t a = 0; a < unknowns; ++a) {
            std::fill_n(column[a], lanes, a == 0 ? 1.0 : 0.0);
            for (std::size_t k = 0; k < a; ++k)
                for (std::size_t i = 0; i < lanes; ++i) column[a][i] -= lower[a][k][i] * column[k][i];
        }
        for (std::size_t a = unknowns; a-- > 0;) {
            for (std::size_t i = 0; i < lanes; ++i) column[a][i] /= diagonal[a][i];
            for (std::size_t k = a + 1; k < unknowns; ++k)
                for (std::size_t i = 0; i < lanes; ++i) column[a][i] -= lower[k][a][i] * column[k][i];
        }
        for (std::size_t a = 0; a < unknowns; ++a)
            for (std::size_t i = 0; i < lanes; ++i)
                kernel[a][i] = moments[0][i] > 0 ? static_cast<float>(column[a][i]) : 0;
    }

    [[gnu::always_inline]] void damp(std::size_t f, double* moment) const {
        const float* const noise = guide.features[f].noise.at(pixel.x, pixel.y);
        for (std::size_t i = 0; i < lanes; ++i)
            moment[i] += damping * moment[i] + moments[0][i] * (noise[i] + double{least_noise});
    }

    [[gnu::always_inline]] void apply() {
        alignas(64) float counts[lanes] = {}, sum[lanes];
        const std::size_t channels = values.channels();
        const auto at_x = static_cast<std::int64_t>(x), at_y = static_cast<std::int64_t>(y);
        for (std::size_t c = 0; c < channels; ++c) std::fill_n(change.row(c, y) + x, lanes, 0.0f);
        for (std::size_t k = 0; k < offsets().size(); ++k) {
            const float* const w = weights_at(k);
            if (!any(w)) continue;
            differences(k);
            for (std::size_t i = 0; i < lanes; ++i) sum[i] = kernel[0][i];
            for (std::size_t f = 0; f < Features; ++f)
                for (std::size_t i = 0; i < lanes; ++i) sum[i] += kernel[f + 1][i] * off[f][i];
            for (std::size_t i = 0; i < lanes; ++i) part[i] = w[i] * sum[i];
            for (std::size_t i = 0; i < lanes; ++i) counts[i] += part[i];
            const auto [dx, dy] = offsets()[k];
            for (std::size_t c = 0; c < channels; ++c) {
                const float* const here = values.at(c, at_x, at_y);
                const float* const there = values.at(c, at_x + dx, at_y + dy);
                float* const out = change.row(c, y) + x;
                for (std::size_t i = 0; i < lanes; ++i) out[i] += part[i] * (there[i] - here[i]);
            }
        }
        // They add up to 1, but for rounding; where that has got the better of them, nothing is changed.
        for (std::size_t i = 0; i < lanes; ++i) part[i] = counts[i] > 0.5f && counts[i] < 2 ? 1 / counts[i] : 0;
        for (std::size_t c = 0; c < channels; ++c) {
            float* const out = change.row(c, y) + x;
            for (std::size_t i = 0; i < lanes; ++i) out[i] *= part[i];
        }
    }
};

bool meets_picture(const Guide& guide, Place pixel) {
    return pixel.y >= 0 && pixel.y < std::int64_t{guide.height} && pixel.x + std::int64_t{lanes} > 0 &&
           pixel.x < std::int64_t{guide.width};
}

template <std::size_t Features>
void fit_with(const Guide& guide, const PairWeights& weights, std::size_t filter, const AreaValues& values, Place area,
              std::size_t row, AreaResult& change) {
    if constexpr (Features > 0)
        if (guide.features.size() < Features)
            return fit_with<Features - 1>(guide, weights, filter, values, area, row, change);
    for (std::size_t y = 0; y < strip_rows; ++y)
        for (std::size_t x = 0; x < area_side; x += lanes) {
            const Place pixel{area.x + std::int64_t(x), area.y + std::int64_t(row + y)};
            if (!meets_picture(guide, pixel)) {
                for (std::size_t c = 0; c < values.channels(); ++c)
                    std::fill_n(change.row(c, row + y) + x, lanes, 0.0f);
                continue;
            }
            LaneFit<Features> fit{guide, weights, filter, values, pixel, x, row + y, y, change, {}, {}, {}, {}};
            work_in_lanes(fit);
        }
}

}  // namespace

void fit_strip(const Guide& guide, const PairWeights& weights, std::size_t filter, const AreaValues& values, Place area,
               std::size_t row, AreaResult& change) {
    static_assert(area_side % lanes == 0 && area_side % strip_rows == 0, "areas are cut into strips and lanes");
    fit_with<most_features>(guide, weights, filter, values, area, row, change);
}

}  // namespace lightnet::cleaning
