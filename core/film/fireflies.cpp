#include "core/film/fireflies.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace lightnet {
namespace {

constexpr std::array<double, 2> shares{0.99, 0.6};  // of all error
constexpr double most_share = 0.005;                // of all pixels: more of them are a noisy picture
constexpr std::size_t least_pixels = 4096;          // fewer tell nothing
constexpr double least_square = 0.01;               // as in compare()
constexpr double least_error = 0.01;                // mean over all pixels: below, nobody sees them

std::vector<float> luminances(const Picture& picture, const std::vector<const PictureLayer*>& layers) {
    std::vector<float> light(std::size_t{picture.width} * picture.height);
    for (const PictureLayer* layer : layers)
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += luminance(layer->pixels[i] * layer->gain);
    return light;
}

}  // namespace

BesideNeighbours beside_neighbours(const Picture& picture, const std::vector<const PictureLayer*>& layers) {
    const std::size_t width = picture.width, height = picture.height;
    const auto light = luminances(picture, layers);
    BesideNeighbours found{std::vector<double>(light.size()), std::vector<double>(light.size())};
    for (std::size_t i = 0; i < light.size(); ++i) found.squares[i] = double{light[i]} * light[i] + least_square;
    for (std::size_t y = 1; y + 1 < height; ++y)
        for (std::size_t x = 1; x + 1 < width; ++x) {
            std::array<float, 8> around;
            std::size_t next = 0;
            for (const std::size_t row : {y - 1, y, y + 1})
                for (const std::size_t column : {x - 1, x, x + 1})
                    if (row != y || column != x) around[next++] = light[row * width + column];
            std::nth_element(around.begin(), around.begin() + 4, around.end());
            const std::size_t i = y * width + x;
            const double median = around[4], off = std::max(0.0, light[i] - median);
            found.squares[i] = median * median + least_square;
            found.off[i] = off * off / found.squares[i];
        }
    return found;
}

std::optional<Fireflies> fireflies_in(const Picture& picture, const std::vector<const PictureLayer*>& layers) {
    const std::size_t width = picture.width, height = picture.height;
    if (width < 3 || height < 3 || width * height < least_pixels) return std::nullopt;
    const auto found = beside_neighbours(picture, layers).off;
    const double all = std::accumulate(found.begin(), found.end(), 0.0), count = double(found.size());
    if (!(all / count >= least_error)) return std::nullopt;
    std::vector<std::size_t> order(found.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto most = std::min(std::size_t(most_share * count) + 1, order.size());
    std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(most), order.end(),
                      [&](std::size_t a, std::size_t b) { return found[a] != found[b] ? found[a] > found[b] : a < b; });
    for (const double share : shares) {
        Fireflies result;
        result.share = share;
        for (double sum = 0; sum < share * all && result.pixels < most;) sum += found[order[result.pixels++]];
        if (result.pixels == most) continue;
        for (std::size_t i = 0; i < std::min(result.pixels, Fireflies::most_places); ++i)
            result.brightest.push_back(
                {picture.x + std::uint32_t(order[i] % width), picture.y + std::uint32_t(order[i] / width)});
        return result;
    }
    return std::nullopt;
}

}  // namespace lightnet
