#include "core/film/gains.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.hpp"
#include "core/film/exr.hpp"
#include "core/film/film.hpp"
#include "core/film/fit.hpp"
#include "tests/film/pictures.hpp"

namespace lightnet::gains_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Gains, AreReadAndWrittenAsWords) {
    EXPECT_EQ(gain_of("bounce=0.5"), (Gain{"bounce", {0.5f, 0.5f, 0.5f}}));
    EXPECT_EQ(gain_of("sky=1.2,1.1,0"), (Gain{"sky", {1.2f, 1.1f, 0}}));
    for (const char* text : {"bounce=0.1", "sky=1.2,1.1,0", "a=1e-30", "a=16777216,0.3333333,3.4e+38"})
        EXPECT_EQ(gain_of(to_string(gain_of(text))), gain_of(text)) << text;
    for (const char* text : {"", "bounce", "=1", "a=", "a=x", "a=1,2", "a=1,2,3,4", "a=-1", "a=inf", "a=nan", "a=1e39",
                             "a=1 ", "a=1,,2", "a=1;2;3"})
        EXPECT_THROW(gain_of(text), Error) << text;
}

TEST(Gains, OfLayersThatAreNotThereAreMistakes) {
    const std::vector<std::string> layers{"emission", "direct", "bounce"};
    EXPECT_THAT(mistakes_in({{"bounce", {}}, {"direct", {}}}, layers), testing::IsEmpty());
    EXPECT_THAT(
        mistakes_in({{"bonce", {}}, {"direct", {}}, {"direct", {}}}, layers),
        ElementsAre("there is no layer 'bonce' (did you mean 'bounce'?); the layers are emission, direct, bounce",
                    "layer 'direct' has more than one gain"));
}

TEST(Gains, ChangeTheBeautyAndNoLayer) {
    Picture picture = noisy_picture(9, 5);
    const auto before = picture;
    mix(picture, {{"Zenith", {0.5f, 2, 0}}});
    for (std::size_t i = 0; i < picture.beauty.size(); ++i) {
        Rgb sum = before.layers[0].pixels[i];
        sum += Rgb{0.5f, 2, 0} * before.layers[1].pixels[i];
        sum += before.layers[2].pixels[i];
        EXPECT_EQ(picture.beauty[i], sum);
        EXPECT_EQ(picture.layers[1].pixels[i], before.layers[1].pixels[i]);
    }
    mix(picture, {});
    EXPECT_TRUE(picture == before) << "they replace each other, and don't pile up";
    EXPECT_THROW(mix(picture, {{"zenith", {}}}), Error);
}

TEST(Gains, OfOneLeaveTheBytesOfAPictureAsTheyAre) {
    Picture picture = noisy_picture(9, 5);
    const auto plain = exr_of(picture);
    mix(picture, {{"Zenith", {1, 1, 1}}});
    EXPECT_EQ(exr_of(picture), plain);
}

TEST(Gains, StayInTheFile) {
    const Folder folder;
    Picture picture = noisy_picture(9, 5);
    mix(picture, {{"emission", {0, 0, 0}}, {"Zenith", {0.5f, 2, 1}}});
    write_exr(folder / "x.exr", picture);
    EXPECT_TRUE(read_exr(folder / "x.exr") == picture);
}

TEST(Gains, ThatTakeAPixelTooFarMakeItBlackInTheBeautyAlone) {
    Picture picture;
    picture.width = 2, picture.height = 1;
    picture.layers = {{"a", {{1e38f, 1, 1}, {1, 1, 1}}}, {"b", {{1, 1, 1}, {1, 1, 1}}}};
    mix(picture, {{"a", {10, 10, 10}}});
    EXPECT_EQ(picture.beauty, (std::vector<Rgb>{{0, 0, 0}, {11, 11, 11}}));
    EXPECT_EQ(picture.overflowed, 1u);
    EXPECT_EQ(picture.layers[0].pixels[0].r, 1e38f);
    mix(picture, {});
    EXPECT_EQ(picture.beauty[0], (Rgb{1e38f, 2, 2}));
}

TEST(Gains, OfAFilmAreThoseOfAMixAfterwards) {
    FilmFormat format{8, 8, {"a", "b"}, 16};
    const auto filled = [](FilmFormat what) {
        Film film(std::move(what));
        for (const auto& tile : tiles_of(film.format(), 8)) {
            auto sums = noise(tile.pixels() * 2, 7);
            sums[4].r = std::numeric_limits<float>::max() / 2;  // and its neighbour: more than a float32 holds together
            film.add(tile, sums);
        }
        return film.picture(3);
    };
    const auto plain = filled(format);
    const std::vector<Gain> gains{{"a", {0.3f, 7, 1e30f}}, {"b", {2, 0, 1}}};
    format.gains = one_for_each(gains, format.layers);
    const auto with_gains = filled(format);
    auto mixed = plain;
    mix(mixed, gains);
    EXPECT_EQ(exr_of(mixed), exr_of(with_gains));
    EXPECT_NE(exr_of(mixed), exr_of(plain));
}

// Photographs of the same layers, with other light.
TEST(Fit, FindsTheGainsThatAPictureWasMixedWith) {
    const Picture picture = noisy_picture(40, 30);
    for (const bool grey : {false, true}) {
        Picture target = picture;
        const std::vector<Gain> gains{{"emission", grey ? Rgb{0.25f, 0.25f, 0.25f} : Rgb{0.25f, 3, 1}},
                                      {"Zenith", {0, 0, 0}},
                                      {picture.layers[2].name, {2, 2, 2}}};
        mix(target, gains);
        const auto found = fit(picture, target, grey);
        ASSERT_EQ(found.size(), 3u);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(found[k].layer, gains[k].layer);
            EXPECT_NEAR(found[k].value.r, gains[k].value.r, 1e-5);
            EXPECT_NEAR(found[k].value.g, gains[k].value.g, 1e-5);
            EXPECT_NEAR(found[k].value.b, gains[k].value.b, 1e-5);
        }
    }
}

// The conditions of Kuhn and Tucker, which hold for the best gains and no others.
TEST(Fit, IsTheNearestThatGainsOfZeroAndMoreReach) {
    const Picture picture = noisy_picture(40, 30);
    Picture target = picture;
    target.beauty = noise(target.beauty.size(), 99);
    for (std::size_t i = 0; i < target.beauty.size(); ++i)  // so that one gain would like to be negative
        target.beauty[i] = target.beauty[i] + picture.layers[0].pixels[i] + -0.5f * picture.layers[1].pixels[i];
    const auto gains = fit(picture, target, false);
    Picture best = picture;
    mix(best, gains);
    bool some_zero = false;
    for (std::size_t k = 0; k < 3; ++k) {
        double slope = 0, size = 0;
        for (std::size_t i = 0; i < best.beauty.size(); ++i) {
            const double layer = picture.layers[k].pixels[i].g;
            slope += layer * (double(target.beauty[i].g) - best.beauty[i].g);
            size += layer * layer;
        }
        if (gains[k].value.g > 0) {
            EXPECT_NEAR(slope / size, 0, 1e-5) << picture.layers[k].name;
        } else {
            EXPECT_LE(slope / size, 1e-5) << picture.layers[k].name;
            some_zero = true;
        }
    }
    EXPECT_TRUE(some_zero);
}

TEST(Fit, TakesLayersThatAreBlackOrAlike) {
    Picture picture = noisy_picture(8, 8);
    picture.layers.push_back({"black", std::vector<Rgb>(64)});
    picture.layers.push_back({"again", picture.layers[0].pixels});
    Picture target = noisy_picture(8, 8);
    target.beauty[5].r = std::numeric_limits<float>::quiet_NaN();
    auto gains = fit(picture, target, false);
    mix(picture, gains);
    for (std::size_t i = 6; i < 64; ++i) EXPECT_NEAR(picture.beauty[i].g / target.beauty[i].g, 1, 1e-4);
    EXPECT_EQ(gains[3].value, (Rgb{0, 0, 0}));
    EXPECT_THROW(fit(picture, noisy_picture(9, 8), false), Error);
}

}  // namespace
}  // namespace lightnet::gains_test
