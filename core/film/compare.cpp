#include "core/film/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t block_size = 16;

std::array<double, 3> channels(Rgb c) { return {c.r, c.g, c.b}; }
double luminance_of(Rgb c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }
double square(double x) { return x * x; }

std::array<double, 3> mean(std::span<const Rgb> pixels) {
    std::array<double, 3> sum{};
    for (const Rgb& pixel : pixels)
        for (std::size_t c = 0; c < 3; ++c) sum[c] += channels(pixel)[c];
    for (double& channel : sum) channel /= static_cast<double>(pixels.size());
    return sum;
}

/// Pixels row by row.
struct View {
    std::uint32_t width = 0;
    std::span<const Rgb> pixels;
    std::size_t height() const { return pixels.size() / width; }
};

// Mean luminance of one block of pixels.
double block_mean(const View& view, std::size_t x0, std::size_t y0) {
    double sum = 0;
    for (std::size_t y = y0; y < y0 + block_size; ++y)
        for (std::size_t x = x0; x < x0 + block_size; ++x) sum += luminance_of(view.pixels[y * view.width + x]);
    return sum / (block_size * block_size);
}

// Over the whole blocks of the picture; a rest at the right and lower border is left out.
double mean_block_difference(const View& reference, const View& picture) {
    double sum = 0;
    std::size_t blocks = 0;
    for (std::size_t y = 0; y + block_size <= picture.height(); y += block_size)
        for (std::size_t x = 0; x + block_size <= picture.width; x += block_size, ++blocks) {
            const double expected = block_mean(reference, x, y);
            sum += std::abs(block_mean(picture, x, y) - expected) / (expected + 1e-3);
        }
    return blocks ? sum / static_cast<double>(blocks) : 0;
}

double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// 1 where both are black.
float ratio(double got, double expected) { return got == expected ? 1 : static_cast<float>(got / expected); }

}  // namespace

Difference compare(std::uint32_t width, std::span<const Rgb> reference, std::span<const Rgb> picture) {
    assert(reference.size() == picture.size() && "pictures of one size");
    const std::size_t pixels = picture.size();
    Difference found;
    found.identical = !std::memcmp(reference.data(), picture.data(), pixels * sizeof(Rgb));
    std::vector<double> relative(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const double expected = channels(reference[i])[c];
            const double d2 = square(channels(picture[i])[c] - expected);
            found.mean_square += d2 / static_cast<double>(3 * pixels);
            relative[i] += d2 / (square(expected) + 0.01) / 3;
        }
    for (double& value : relative)  // what is no number is as far off as can be
        if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
    found.relative_square = mean_of(relative);
    std::sort(relative.begin(), relative.end());
    const std::size_t worst = std::max<std::size_t>(1, pixels / 1000);
    found.relative_square_trimmed = pixels > worst ? mean_of(std::span(relative).first(pixels - worst)) : 0;
    found.block_difference = mean_block_difference({width, reference}, {width, picture});
    const auto expected = mean(reference), got = mean(picture);
    found.mean_ratio = {ratio(got[0], expected[0]), ratio(got[1], expected[1]), ratio(got[2], expected[2])};
    return found;
}

void refuse_other_size(const Picture& reference, const Picture& picture) {
    if (reference.width != picture.width || reference.height != picture.height)
        throw Error("compare", fmt::format("a picture of {}x{} pixels and one of {}x{}", reference.width,
                                           reference.height, picture.width, picture.height));
}

Difference compare(const Picture& reference, const Picture& picture) {
    refuse_other_size(reference, picture);
    return compare(picture.width, reference.beauty, picture.beauty);
}

}  // namespace lightnet
