#include "core/film/clean/clean.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "core/film/clean_layers.hpp"
#include "core/film/compare.hpp"
#include "core/film/gains.hpp"
#include "tests/film/pictures.hpp"

namespace lightnet::clean_test {
namespace {

using Truth = std::function<Rgb(std::uint32_t x, std::uint32_t y)>;

/// A picture whose two halves have noise of their own, of that deviation in parts of the truth.
Picture rendered(std::uint32_t width, std::uint32_t height, const std::vector<std::pair<std::string, Truth>>& layers,
                 float noise, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    const auto off = [&] {  // of deviation 1, evenly spread
        return (static_cast<float>(random() >> 8) * 0x1p-24f - 0.5f) * std::sqrt(12.0f);
    };
    Picture picture{width, height, {}, {}};
    for (const auto& [name, truth] : layers) {
        PictureLayer layer{name, {}}, half{cleaning::half_of(name), {}};
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const Rgb first = truth(x, y) * (0.5f + 0.5f * noise * off());
                half.pixels.push_back(truth(x, y) * (0.5f + 0.5f * noise * off()));
                layer.pixels.push_back(first + half.pixels.back());
            }
        picture.layers.push_back(std::move(layer));
        picture.shown.push_back(std::move(half));
    }
    make_beauty(picture);
    return picture;
}

void show(Picture& picture, const std::string& name, const Truth& truth) {
    PictureLayer layer{name, {}};
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) layer.pixels.push_back(truth(x, y));
    picture.shown.push_back(std::move(layer));
}

Picture true_picture(std::uint32_t width, std::uint32_t height, const Truth& truth) {
    return rendered(width, height, {{"all", truth}}, 0);
}

Rgb ramp(std::uint32_t x, std::uint32_t y) { return {0.2f + 0.004f * float(x), 0.4f, 0.3f + 0.002f * float(y)}; }
Rgb step(std::uint32_t x, std::uint32_t) { return x < 30 ? Rgb{0.1f, 0.1f, 0.1f} : Rgb{1, 0.8f, 0.6f}; }
Rgb checks(std::uint32_t x, std::uint32_t y) {
    return (x / 3 + y / 3) % 2 ? Rgb{0.9f, 0.9f, 0.9f} : Rgb{0.2f, 0.2f, 0.4f};
}

double error_of(const Picture& picture, const Picture& truth) { return compare(truth, picture).relative_square; }

TEST(Clean, TakesMostOfTheNoiseOutOfWhatIsSmooth) {
    const Picture noisy = rendered(90, 70, {{"direct", ramp}}, 0.3f), truth = true_picture(90, 70, ramp);
    EXPECT_LT(error_of(clean(noisy).picture, truth), error_of(noisy, truth) / 10);
}

TEST(Clean, KeepsAStepThatNothingElseShows) {
    const Picture noisy = rendered(64, 64, {{"direct", step}}, 0.2f), truth = true_picture(64, 64, step);
    const Picture cleaned = clean(noisy).picture;
    EXPECT_LT(error_of(cleaned, truth), error_of(noisy, truth) / 5);
    double left = 0, right = 0;
    for (std::uint32_t y = 0; y < 64; ++y) {
        left += cleaned.beauty[std::size_t{y} * 64 + 29].g / 64;
        right += cleaned.beauty[std::size_t{y} * 64 + 30].g / 64;
    }
    EXPECT_NEAR(left, 0.1, 0.02);
    EXPECT_NEAR(right, 0.8, 0.04);
}

TEST(Clean, SpreadsAFireflyAndKeepsItsLight) {
    const Rgb grey{0.5f, 0.5f, 0.5f};
    Picture noisy = rendered(64, 64, {{"direct", [&](auto, auto) { return grey; }}}, 0.2f);
    const std::size_t place = 64 * 30 + 33;
    noisy.layers[0].pixels[place] += Rgb{300, 200, 100};  // in the first half alone
    make_beauty(noisy);
    const Picture cleaned = clean(noisy).picture;
    float brightest = 0;
    double before = 0, after = 0;
    for (std::size_t i = 0; i < noisy.beauty.size(); ++i) {
        brightest = std::max(brightest, cleaned.beauty[i].r);
        before += double{noisy.beauty[i].r}, after += double{cleaned.beauty[i].r};
    }
    EXPECT_LT(brightest, 300.0f / 20);
    EXPECT_NEAR(after / before, 1, 0.05);
}

TEST(Clean, KeepsATextureThatIsInAFeature) {
    Picture noisy = rendered(96, 64, {{"direct", checks}}, 0.5f);
    const Picture truth = true_picture(96, 64, checks);
    const double without = error_of(clean(noisy).picture, truth);
    show(noisy, "clean_albedo", checks);
    const double with = error_of(clean(noisy).picture, truth);
    EXPECT_LT(with, error_of(noisy, truth) / 8);
    EXPECT_LT(with, without);
}

TEST(Clean, LeavesAConstantPictureAsItIsToTheBit) {
    const Truth constant = [](std::uint32_t, std::uint32_t) { return Rgb{0.1f, 2.7f, 1e-5f}; };
    const Picture noisy = rendered(40, 30, {{"direct", constant}, {"bounce", constant}}, 0);
    const Picture cleaned = clean(noisy).picture;
    EXPECT_EQ(cleaned.beauty, noisy.beauty);
    for (std::size_t l = 0; l < 2; ++l) EXPECT_EQ(cleaned.layers[l].pixels, noisy.layers[l].pixels);
}

TEST(Clean, MakesTheBeautyTheSumOfTheLayers) {
    const Picture cleaned =
        clean(rendered(50, 50, {{"direct", ramp}, {"bounce", step}, {"sky", checks}}, 0.4f)).picture;
    for (std::size_t i = 0; i < cleaned.beauty.size(); ++i) {
        Rgb sum = cleaned.layers[0].pixels[i];
        sum += cleaned.layers[1].pixels[i];
        sum += cleaned.layers[2].pixels[i];
        ASSERT_EQ(cleaned.beauty[i], sum);
    }
}

TEST(Clean, CommutesWithRemixingBitForBit) {
    const Picture noisy = rendered(50, 40, {{"direct.key", ramp}, {"direct.rest", step}, {"bounce", checks}}, 0.4f);
    const std::vector<Gain> gains{{"direct", {0.3f, 1.7f, 5}}, {"key", {2, 2, 2}}, {"bounce", {0, 1, 0.1f}}};
    Picture mixed_first = noisy, mixed_last = clean(noisy).picture;
    mix(mixed_first, gains);
    mix(mixed_last, gains);
    EXPECT_EQ(clean(mixed_first).picture, mixed_last);
}

TEST(Clean, TreatsEachLayerAsIfTheOthersWereInItsSum) {
    // one set of weights: the layers of a picture are cleaned as their sum is, but for rounding
    const Picture apart = rendered(60, 60, {{"direct", ramp}, {"bounce", checks}}, 0.3f);
    Picture together{60, 60, {}, {}};
    together.layers = {{"all", sum_of(apart.layers)}};
    PictureLayer half{"half.all", apart.shown[0].pixels};
    for (std::size_t i = 0; i < half.pixels.size(); ++i) half.pixels[i] += apart.shown[1].pixels[i];
    together.shown = {half};
    make_beauty(together);
    const Picture a = clean(apart).picture, b = clean(together).picture;
    for (std::size_t i = 0; i < a.beauty.size(); ++i) ASSERT_NEAR(a.beauty[i].g, b.beauty[i].g, 2e-5);
}

TEST(Clean, SaysHowFarOffItIs) {
    const Picture noisy = rendered(128, 128, {{"direct", ramp}}, 0.4f), truth = true_picture(128, 128, ramp);
    const Picture cleaned = clean(noisy).picture;
    double expected = 0, true_error = error_of(cleaned, truth);
    for (const auto& error : cleaned.shown.back().pixels) expected += error.r * error.r / (128.0 * 128);
    EXPECT_EQ(cleaned.shown.back().name, "clean_error");
    EXPECT_LT(std::sqrt(expected / true_error), 1.75);  // rather too much than too little
    EXPECT_GT(std::sqrt(expected / true_error), 1 / 1.5);
}

TEST(Clean, KeepsWhatItDoesNotClean) {
    Picture noisy = rendered(8, 8, {{"direct", ramp}}, 0.1f);
    noisy.alpha.assign(64, 0.5f);
    noisy.notes.texts["seed"] = "7";
    noisy.mattes = {{"objects", 2, std::vector<Covered>(128), "{}"}};
    noisy.layers[0].gain = {2, 1, 1};
    make_beauty(noisy);
    show(noisy, "uv", ramp);
    show(noisy, "clean_albedo", ramp);
    const Picture cleaned = clean(noisy).picture;
    EXPECT_EQ(cleaned.alpha, noisy.alpha);
    EXPECT_EQ(cleaned.mattes, noisy.mattes);
    EXPECT_EQ(cleaned.notes.texts.at("seed"), "7");
    EXPECT_TRUE(cleaned.notes.texts.contains(cleaned_note));
    EXPECT_EQ(cleaned.layers[0].gain, (Rgb{2, 1, 1}));
    ASSERT_EQ(cleaned.shown.size(), 2u);
    EXPECT_EQ(cleaned.shown[0].name, "uv");
    EXPECT_EQ(cleaned.shown[1].name, "clean_error");
}

TEST(Clean, SaysWhatIsLacking) {
    Picture noisy = rendered(20, 20, {{"direct", ramp}}, 0.2f);
    EXPECT_THAT(clean(noisy).lacks, testing::ElementsAre(testing::HasSubstr("albedo")));
    show(noisy, "albedo", checks);
    EXPECT_THAT(clean(noisy).lacks, testing::IsEmpty());
    std::erase_if(noisy.shown, [](const auto& layer) { return cleaning::is_half(layer.name); });
    EXPECT_THAT(clean(noisy).lacks, testing::ElementsAre(testing::HasSubstr("halves")));
}

TEST(Clean, SaysOfACropThatItsBorderDiffers) {
    Picture whole = rendered(20, 20, {{"direct", ramp}}, 0.2f);
    show(whole, "clean_albedo", checks);
    EXPECT_THAT(clean(whole).lacks, testing::IsEmpty());
    whole.x = 30, whole.whole_width = 64, whole.whole_height = 20;
    EXPECT_THAT(clean(whole).lacks, testing::ElementsAre(testing::HasSubstr("border")));
}

TEST(Clean, FitsMorePlanesAtBest) {
    const Picture noisy = rendered(96, 64, {{"direct", step}}, 0.4f), truth = true_picture(96, 64, step);
    EXPECT_LT(error_of(clean(noisy, CleanQuality::best).picture, truth), error_of(clean(noisy).picture, truth));
}

TEST(Clean, FitsFewerPlanesForADraft) {
    Picture noisy = rendered(96, 96, {{"direct", checks}}, 0.3f);
    show(noisy, "clean_albedo", checks);
    const Picture draft = clean(noisy, CleanQuality::draft).picture, usual = clean(noisy).picture;
    const Picture truth = true_picture(96, 96, checks);
    EXPECT_LT(error_of(draft, truth), error_of(noisy, truth) / 5);
    EXPECT_GT(error_of(draft, truth), error_of(usual, truth));
}

TEST(Clean, OfPicturesWithoutHalvesTakesNoiseOutToo) {
    Picture noisy = rendered(80, 80, {{"direct", ramp}}, 0.3f);
    const Picture truth = true_picture(80, 80, ramp);
    noisy.shown.clear();
    EXPECT_LT(error_of(clean(noisy).picture, truth), error_of(noisy, truth) / 3);
    noisy.layers.clear();
    EXPECT_LT(error_of(clean(noisy).picture, truth), error_of(noisy, truth) / 3);
}

TEST(Clean, TakesAnyNumbers) {
    Picture noisy = rendered(30, 30, {{"direct", ramp}, {"bounce", step}}, 0.3f);
    constexpr float huge = std::numeric_limits<float>::max(), nan = std::numeric_limits<float>::quiet_NaN();
    noisy.layers[0].pixels[100] = {nan, nan, nan};
    noisy.layers[0].pixels[205] = {huge, huge, huge};
    noisy.layers[1].pixels[207] = {std::numeric_limits<float>::infinity(), 1, 1};
    noisy.shown[0].pixels[300] = {nan, 0, 0};
    show(noisy, "clean_depth", [](std::uint32_t x, std::uint32_t) { return x == 3 ? Rgb{1e30f, 0, 0} : Rgb{1, 1, 1}; });
    const Picture cleaned = clean(noisy).picture;
    for (const auto& pixel : cleaned.beauty) ASSERT_TRUE(finite(pixel));
}

TEST(Clean, OfOnePixelAndOfOneSampleIsThePictureItself) {
    const Picture one = rendered(1, 1, {{"direct", ramp}}, 0.3f);
    EXPECT_EQ(clean(one).picture.beauty, one.beauty);
    const Picture row = rendered(300, 1, {{"direct", ramp}}, 0.1f);
    EXPECT_EQ(clean(row).picture.beauty.size(), 300u);
}

/// A part of a picture as a crop of it, from that pixel on.
Picture part_of(const Picture& whole, std::uint32_t left, std::uint32_t top, std::uint32_t width,
                std::uint32_t height) {
    Picture piece{width, height, {}, {}, left, top, whole.width, whole.height};
    const auto cut = [&](const PictureLayer& layer) {
        PictureLayer part{layer.name, {}};
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x)
                part.pixels.push_back(layer.pixels[(y + top) * whole.width + x + left]);
        return part;
    };
    piece.layers = {cut(whole.layers[0])}, piece.shown = {cut(whole.shown[0])};
    make_beauty(piece);
    return piece;
}

TEST(Clean, KnowsNothingOfWhereItsAreasLie) {
    // far from the border, a piece of a picture is cleaned as the whole is, wherever areas begin
    const Picture wide = rendered(460, 40, {{"direct", ramp}}, 0.3f),
                  high = rendered(40, 460, {{"direct", ramp}}, 0.3f);
    const Picture a = clean(wide).picture, of_a = clean(part_of(wide, 41, 0, 400, 40)).picture, b = clean(high).picture,
                  of_b = clean(part_of(high, 0, 38, 40, 400)).picture;
    for (std::uint32_t along = 166; along < 234; ++along)
        for (std::uint32_t across = 0; across < 40; ++across) {
            ASSERT_EQ(a.beauty[across * 460 + along + 41], of_a.beauty[across * 400 + along])
                << along << ", " << across;
            ASSERT_EQ(b.beauty[(along + 38) * 40 + across], of_b.beauty[along * 40 + across])
                << along << ", " << across;
        }
}

// Root mean square of what means over blocks of 16 x 16 pixels are off by.
double means_off(const Picture& picture, const Picture& truth) {
    double sum = 0;
    for (std::uint32_t top = 0; top < picture.height; top += 16)
        for (std::uint32_t left = 0; left < picture.width; left += 16) {
            double off = 0;
            for (std::uint32_t i = 0; i < 256; ++i) {
                const std::size_t pixel = std::size_t{top + i / 16} * picture.width + left + i % 16;
                off += double{picture.beauty[pixel].g} - truth.beauty[pixel].g;
            }
            sum += off * off / 65536;
        }
    return std::sqrt(sum / (picture.width / 16 * (picture.height / 16)));
}

TEST(Clean, LeavesMeansOverBlocksAsGoodAsTheyWere) {
    // a pattern whose contrast is no more than the noise's: across its edges more light is moved than means over blocks
    // have noise
    const Truth pattern = [](std::uint32_t x, std::uint32_t y) {
        const float value = 1 + 0.2f * float((x / 20 + y / 20) % 2);
        return Rgb{value, value, value};
    };
    const Picture truth = true_picture(192, 192, pattern);
    double noisy_off = 0, cleaned_off = 0;
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        const Picture noisy = rendered(192, 192, {{"direct", pattern}}, 0.2f, seed), cleaned = clean(noisy).picture;
        noisy_off += means_off(noisy, truth), cleaned_off += means_off(cleaned, truth);
    }
    EXPECT_LT(cleaned_off, noisy_off);
}

TEST(Clean, LeavesNoLayerDarkerThanBlack) {
    const Truth sparks = [](std::uint32_t x, std::uint32_t y) { return (x * 7 + y * 13) % 11 ? Rgb{} : Rgb{9, 9, 9}; };
    const Picture cleaned = clean(rendered(50, 50, {{"direct", sparks}, {"bounce", ramp}}, 0.5f)).picture;
    for (const auto& layer : cleaned.layers)
        for (const auto& pixel : layer.pixels) ASSERT_GE(std::min({pixel.r, pixel.g, pixel.b}), 0);
}

}  // namespace
}  // namespace lightnet::clean_test
