// FLIP against values worked out by hand, and against what it promises.
#include "core/film/flip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/film/perceived_colour.hpp"

namespace lightnet::flip_test {
namespace {

constexpr std::uint32_t side = 64;

std::vector<Rgb> even(Rgb colour) { return std::vector<Rgb>(std::size_t{side} * side, colour); }

double flip_of(const std::vector<Rgb>& reference, const std::vector<Rgb>& picture, const FlipView& view = {}) {
    return flip(side, reference, picture, view).mean;
}

std::vector<Rgb> with_noise(std::vector<Rgb> pixels, float amplitude) {
    std::mt19937 random(1);
    for (Rgb& pixel : pixels) {
        const float noise = (static_cast<float>(random() >> 8) * 0x1p-24f - 0.5f) * amplitude;
        pixel += Rgb{noise, noise, noise};
    }
    return pixels;
}

// Two even pictures have neither edges nor points, and smoothing leaves them as they are, so FLIP is that of their
// colours alone. White has L* = 100 and no chroma, black 0: HyAB is 100, and 100^0.7 = 25.12. The largest difference
// there is, of green and blue, is |87.73 - 32.30| + |(-75.6, 72.98) - (25.58, -34.84)| = 55.43 + 147.86 = 203.3 with
// the Hunt effect (chroma times L*/100), and 203.3^0.7 = 41.28. 25.12 lies beyond the knee at 0.4 × 41.28 = 16.51,
// which has the value 0.95: 0.95 + 0.05 × (25.12 - 16.51) / (41.28 - 16.51) = 0.967.
TEST(Flip, OfBlackAndWhiteIsWhatTheFormulaSays) {
    EXPECT_NEAR(flip_of(even({0, 0, 0}), even({1, 1, 1})), 0.967, 0.001);
    EXPECT_NEAR(flip_of(even({1, 1, 1}), even({0, 0, 0})), 0.967, 0.001);
}

// Below the knee: mid grey, 0.18, has L* = 116 × 0.18^(1/3) - 16 = 49.50; 0.2 has 51.84. 2.34^0.7 = 1.813, and 0.95 ×
// 1.813 / 16.51 = 0.1043.
TEST(Flip, OfTwoGreysIsWhatTheFormulaSays) {
    EXPECT_NEAR(flip_of(even({0.18f, 0.18f, 0.18f}), even({0.2f, 0.2f, 0.2f})), 0.1043, 0.0005);
}

TEST(Flip, OfGreenAndBlueIsOne) { EXPECT_NEAR(flip_of(even({0, 1, 0}), even({0, 0, 1})), 1, 1e-5); }

TEST(Flip, OfTheSamePictureIsNothing) {
    const auto noise = with_noise(even({0.5f, 0.3f, 0.1f}), 0.4f);
    const Flip same = flip(side, noise, noise);
    EXPECT_EQ(same.mean, 0);
    for (const float value : same.map) EXPECT_EQ(value, 0);
}

TEST(Flip, GrowsWithNoise) {
    const auto grey = even({0.3f, 0.3f, 0.3f});
    double before = 0;
    for (const float amplitude : {0.01f, 0.03f, 0.1f, 0.2f, 0.4f, 0.6f}) {
        const double now = flip_of(grey, with_noise(grey, amplitude));
        EXPECT_GT(now, before) << amplitude;
        before = now;
    }
    EXPECT_LT(before, 1);
}

TEST(Flip, FindsNewEdgesWorseThanEvenChanges) {
    const auto before = even({0.2f, 0.2f, 0.2f});
    auto after = before;
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = side / 2; x < side; ++x) after[y * side + x] = {0.25f, 0.25f, 0.25f};
    const auto map = flip(side, before, after).map;
    const auto at = [&](std::uint32_t x) { return map[side / 2 * side + x]; };
    EXPECT_NEAR(at(side - 1), flip_of(before, even({0.25f, 0.25f, 0.25f})), 1e-4) << "far from the edge";
    EXPECT_GT(at(side / 2 + 3), 1.15f * at(side - 1)) << "though its colour is no further off";
    EXPECT_EQ(at(0), 0);
}

TEST(Flip, FindsOnePixelThatIsNew) {
    const auto before = even({0.2f, 0.2f, 0.2f});
    auto after = before;
    after[side / 2 * side + side / 2] = {1, 1, 1};
    const auto map = flip(side, before, after).map;
    const float there = map[side / 2 * side + side / 2];
    EXPECT_GT(there, 0.3f);
    for (const float value : map) EXPECT_LE(value, there);
}

TEST(Flip, SeesFineDetailWorseFromAfar) {
    const auto grey = even({0.3f, 0.3f, 0.3f}), noise = with_noise(grey, 0.2f);
    EXPECT_GT(flip_of(grey, noise, {.pixels_per_degree = 20}), flip_of(grey, noise, {.pixels_per_degree = 67}));
    EXPECT_GT(flip_of(grey, noise, {.pixels_per_degree = 67}), flip_of(grey, noise, {.pixels_per_degree = 200}));
}

TEST(Flip, LooksAtWhatAPngWouldShow) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(flip_of(even({2, 3, 4}), even({1, 1, 1})), 0) << "both are clipped to white";
    EXPECT_EQ(flip_of(even({nan, -1, 0}), even({0, 0, 0})), 0) << "what is no light is black";
    EXPECT_GT(flip_of(even({2, 3, 4}), even({1, 1, 1}), {.exposure = -2}), 0.1) << "darker, they differ";
}

float linear_of(int shown) {
    const float c = static_cast<float>(shown) / 255;
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

// Worked out by formulas of the article as they stand there: filters in two dimensions, of double precision.
TEST(Flip, IsThatOfAnImplementationWithoutShortcuts) {
    constexpr int small = 24;
    std::vector<Rgb> reference, picture;
    for (int i = 0; i < small * small; ++i) {
        const int x = i % small, y = i / small, shown[] = {x * 9, y * 9, x * y % 256};
        const auto noisy = [&](int k) { return std::clamp(shown[k] + (i * 3 + k) * 7919 % 81 - 40, 0, 255); };
        reference.push_back({linear_of(shown[0]), linear_of(shown[1]), linear_of(shown[2])});
        picture.push_back({linear_of(noisy(0)), linear_of(noisy(1)), linear_of(noisy(2))});
    }
    EXPECT_NEAR(flip(small, reference, picture).mean, 0.13730953, 1e-5);
}

TEST(PerceivedColour, GoesToYCxCzAndBack) {
    for (const Rgb colour : {Rgb{0, 0, 0}, Rgb{1, 1, 1}, Rgb{0.2f, 0.7f, 0.1f}, Rgb{1, 0, 0}}) {
        const Rgb again = rgb_of_ycxcz(ycxcz_of(colour));
        EXPECT_NEAR(again.r, colour.r, 1e-6);
        EXPECT_NEAR(again.g, colour.g, 1e-6);
        EXPECT_NEAR(again.b, colour.b, 1e-6);
    }
}

// CIELAB of pure green and blue of sRGB, as any table has it: (87.73, -86.18, 83.18) and (32.30, 79.19, -107.86).
TEST(PerceivedColour, KnowsTheLabOfPureColours) {
    const auto green = hunt_lab_of({0, 1, 0}), blue = hunt_lab_of({0, 0, 1});
    EXPECT_NEAR(green[0], 87.73, 0.02);
    EXPECT_NEAR(green[1], -86.18 * 0.8773, 0.05);
    EXPECT_NEAR(green[2], 83.18 * 0.8773, 0.05);
    EXPECT_NEAR(blue[0], 32.30, 0.02);
    EXPECT_NEAR(blue[1], 79.19 * 0.3230, 0.05);
    EXPECT_NEAR(blue[2], -107.86 * 0.3230, 0.05);
}

}  // namespace
}  // namespace lightnet::flip_test
