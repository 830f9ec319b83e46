#include "tools/trials/trial_errors.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace lightnet {
namespace {

constexpr std::uint32_t block = 8;    // pixels along a side
constexpr std::uint32_t around = 2;   // pixels on each side whose light is that of a pixel
constexpr double least_light = 0.01;  // squared, as in compare()
constexpr double left_out = 0.001;

using Channels = std::array<double, 3>;

Channels channels_of(const Rgb& colour) { return {colour.r, colour.g, colour.b}; }

/// A part of all pictures.
struct PixelBlock {
    std::uint32_t x0, y0, x1, y1;  // the last ones are excluded
};

/// By what one picture differs from another, or from the mean of two.
using Differences = std::vector<Channels>;

/// All pictures of one size, and what their errors are compared with.
class PairErrors {
public:
    PairErrors(const PicturePair& pair, const std::vector<Picture>& singles)
        : width_(pair[0].width), height_(pair[0].height), scale_(light_of(pair, singles)) {
        for (Channels& all : scale_)
            for (double& light : all) light = 1 / (light * light + least_light);
    }

    /// Mean squares: of pixels, and of what blocks of them have in common.
    struct Squares {
        double of_pixels = 0, of_blocks = 0, part = 0;  // a block of independent pixels has so much of their square
    };
    Squares squares(const Differences& off, const std::vector<bool>& counts) const {
        const auto square = squares_of(off);
        Squares found;
        double pixels = 0, blocks = 0;
        for (std::size_t i = 0; i < square.size(); ++i)
            if (counts[i]) found.of_pixels += square[i], ++pixels;
        for_blocks([&](const PixelBlock& at) {
            Channels sum{};
            double count = 0;
            for_pixels(at, [&](std::size_t i) {
                if (!counts[i]) return;
                for (std::size_t c = 0; c < 3; ++c) sum[c] += off[i][c] * std::sqrt(scale_[i][c]);
                ++count;
            });
            if (count < 2) return;
            for (const double one : sum) found.of_blocks += one * one / (count * count) / 3;
            found.part += 1 / count, ++blocks;
        });
        found.of_pixels /= std::max(1.0, pixels);
        found.of_blocks /= std::max(1.0, blocks), found.part /= std::max(1.0, blocks);
        return found;
    }

    /// All but the worst.
    std::vector<bool> quiet(const Differences& off) const {
        const auto squares = squares_of(off);
        std::vector<double> sorted = squares;
        const auto most = sorted.begin() + std::ptrdiff_t(left_out * double(squares.size()));
        std::nth_element(sorted.begin(), most, sorted.end(), std::greater<>());
        std::vector<bool> counts;
        for (const double one : squares) counts.push_back(one <= *most);
        return counts;
    }

private:
    // The mean of all pictures, of the pixels around each.
    std::vector<Channels> light_of(const PicturePair& pair, const std::vector<Picture>& singles) const {
        std::vector<Channels> sum(std::size_t{width_} * height_), smooth(sum.size());
        const auto add = [&](const Picture& picture) {
            for (std::size_t i = 0; i < sum.size(); ++i)
                for (std::size_t c = 0; c < 3; ++c) sum[i][c] += channels_of(picture.beauty[i])[c];
        };
        for (const auto& picture : pair) add(picture);
        for (const auto& picture : singles) add(picture);
        for (std::uint32_t y = 0; y < height_; ++y)
            for (std::uint32_t x = 0; x < width_; ++x) {
                const PixelBlock near{x - std::min(x, around), y - std::min(y, around),
                                      std::min(x + around + 1, width_), std::min(y + around + 1, height_)};
                Channels& mean = smooth[index(x, y)];
                for_pixels(near, [&](std::size_t i) {
                    for (std::size_t c = 0; c < 3; ++c) mean[c] += sum[i][c];
                });
                const double count = double((near.x1 - near.x0) * (near.y1 - near.y0)) * double(2 + singles.size());
                for (double& light : mean) light /= count;
            }
        return smooth;
    }

    std::vector<double> squares_of(const Differences& off) const {
        std::vector<double> squares(off.size());
        for (std::size_t i = 0; i < squares.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) squares[i] += off[i][c] * off[i][c] * scale_[i][c] / 3;
        return squares;
    }

    std::size_t index(std::uint32_t x, std::uint32_t y) const { return std::size_t{y} * width_ + x; }
    template <class Use>
    void for_pixels(const PixelBlock& at, const Use& use) const {
        for (std::uint32_t y = at.y0; y < at.y1; ++y)
            for (std::uint32_t x = at.x0; x < at.x1; ++x) use(index(x, y));
    }
    template <class Use>
    void for_blocks(const Use& use) const {
        for (std::uint32_t y = 0; y < height_; y += block)
            for (std::uint32_t x = 0; x < width_; x += block)
                use(PixelBlock{x, y, std::min(x + block, width_), std::min(y + block, height_)});
    }

    std::uint32_t width_, height_;
    std::vector<Channels> scale_;  // 1 / (light² + least_light)
};

// Of the first picture's colours, and of both singles' times these factors.
Differences differences(const Picture& picture, const PicturePair& singles, double first, double second) {
    Differences off(picture.beauty.size());
    for (std::size_t i = 0; i < off.size(); ++i) {
        const Channels own = channels_of(picture.beauty[i]);
        const Channels one = channels_of(singles[0].beauty[i]), other = channels_of(singles[1].beauty[i]);
        for (std::size_t c = 0; c < 3; ++c) off[i][c] = own[c] + first * one[c] + second * other[c];
    }
    return off;
}

}  // namespace

std::vector<TrialErrors> errors_of(const PicturePair& pair, const std::vector<Picture>& singles) {
    constexpr double least_told = 0.02;
    const PairErrors compared(pair, singles);
    // Half of the difference of the two: as far off as their mean.
    const auto off = differences(pair[0], pair, -0.5, -0.5);
    const std::vector<bool> everywhere(off.size(), true), quiet = compared.quiet(off);
    std::vector<TrialErrors> all{{2 * compared.squares(off, everywhere).of_pixels, 0}};
    const auto noise = compared.squares(off, quiet);
    for (const auto& picture : singles) {
        const auto found = compared.squares(differences(picture, pair, -0.5, -0.5), quiet);
        const double pixels = found.of_pixels - noise.of_pixels, blocks = found.of_blocks - noise.of_blocks;
        const double shared = std::max(0.0, (blocks - pixels * found.part) / (1 - found.part));
        all.push_back({std::max(least_told * 2 * noise.of_pixels, pixels - shared), shared});
    }
    return all;
}

}  // namespace lightnet
