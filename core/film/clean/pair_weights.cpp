#include "core/film/clean/pair_weights.hpp"

#include <cmath>

#include "core/base/math/columns.hpp"
#include "core/base/math/exponential.hpp"

namespace lightnet::cleaning {
namespace {

constexpr std::size_t around = 2 * patch;
constexpr std::size_t wide = area_side + around, tall = strip_rows + around;
constexpr float farthest = 10;  // beyond this, weights are 0

/// One offset for one strip: distances of single pixels, of patches, and weights.
struct StripWeights {
    std::array<const float*, 3> colour, variance;  // of the upper left pixel that is needed
    const float* inside;                           // of the upper left pixel of the strip, off by the offset
    std::size_t stride;                            // of all sheets
    std::ptrdiff_t off;                            // the offset, in them
    std::array<float*, filters> weights;
    float pixels[tall][wide];
    float sums[tall][area_side];

    [[gnu::always_inline]] void work() {
        for (std::size_t y = 0; y < tall; ++y) {
            row_of_pixels(y);
            row_of_sums(y);
        }
        for (std::size_t y = 0; y < strip_rows; ++y) row_of_weights(y);
    }

private:
    [[gnu::always_inline]] void row_of_pixels(std::size_t y) {
        float* const row = pixels[y];
        for (std::size_t x = 0; x < wide; ++x) row[x] = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const float* const u = colour[c] + y * stride;
            const float* const v = variance[c] + y * stride;
            const float *const other_u = u + off, *const other_v = v + off;
            for (std::size_t x = 0; x < wide; ++x) {
                const float apart = u[x] - other_u[x], p = v[x], q = other_v[x];
                row[x] += (apart * apart - (p + (p < q ? p : q))) / (1e-10f + p + q);
            }
        }
    }
    [[gnu::always_inline]] void row_of_sums(std::size_t y) {
        const float* const row = pixels[y];
        float* const sum = sums[y];
        for (std::size_t x = 0; x < area_side; ++x) sum[x] = row[x] + row[x + 1] + row[x + 2] + row[x + 3] + row[x + 4];
    }
    [[gnu::always_inline]] void row_of_weights(std::size_t y) {
        static_assert(patch == 2, "the sums are of five");
        const float* const in = inside + y * stride;
        for (std::size_t f = 0; f < filters; ++f) {
            const float scale = 1 / (3 * 25 * tolerance[f] * tolerance[f]);
            float* const out = weights[f] + y * area_side;
            for (std::size_t x = 0; x < area_side; ++x) {
                const float sum = sums[y][x] + sums[y + 1][x] + sums[y + 2][x] + sums[y + 3][x] + sums[y + 4][x];
                const float distance = sum > 0 ? sum * scale : 0;
                const float weight = exponential(-distance) * in[x];
                out[x] = distance < farthest ? weight : 0;
            }
        }
    }
};

std::vector<Offset> all_offsets() {
    std::vector<Offset> all;
    const auto most = static_cast<std::int32_t>(reach);
    for (std::int32_t y = -most; y <= most; ++y)
        for (std::int32_t x = -most; x <= most; ++x)
            if (x * x + y * y <= most * most) all.push_back({x, y});
    return all;
}

}  // namespace

const std::vector<Offset>& offsets() {
    static const std::vector<Offset> all = all_offsets();
    return all;
}

PairWeights::PairWeights() : weights_(filters * offsets().size() * strip_pixels) {}

void PairWeights::make(const Guide& guide, std::size_t half, Place place) {
    StripWeights strip{};
    constexpr auto back = std::int64_t{patch};
    strip.stride = guide.inside.stride();
    for (std::size_t c = 0; c < 3; ++c) {
        strip.colour[c] = guide.half[half][c].at(place.x - back, place.y - back);
        strip.variance[c] = guide.variance[c].at(place.x - back, place.y - back);
    }
    for (std::size_t k = 0; k < offsets().size(); ++k) {
        const auto [x, y] = offsets()[k];
        strip.off = y * static_cast<std::ptrdiff_t>(strip.stride) + x;
        strip.inside = guide.inside.at(place.x + x, place.y + y);
        for (std::size_t f = 0; f < filters; ++f)
            strip.weights[f] = weights_.data() + (f * offsets().size() + k) * strip_pixels;
        work_in_lanes(strip);
    }
}

}  // namespace lightnet::cleaning
