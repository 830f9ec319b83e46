// Pictures compared layer by layer, and pictures of their differences.
#include "core/film/compare_layers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.hpp"
#include "core/film/png.hpp"
#include "tests/film/pictures.hpp"

namespace lightnet::compare_layers_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> names_of(const Comparison& found) {
    std::vector<std::string> names;
    for (const auto& layer : found.layers) names.push_back(layer.layer);
    return names;
}

TEST(CompareLayers, TellsEachLayerByItsName) {
    const Picture reference = noisy_picture(20, 10);
    Picture picture = reference;
    for (Rgb& colour : picture.layers[1].pixels) colour *= 2;
    picture.beauty = sum_of(picture.layers);
    const Comparison found = compare_layers(reference, picture);
    EXPECT_THAT(names_of(found),
                ElementsAre("beauty", "emission", "Zenith", "a_node_whose_name_is_longer_than_31_letters"));
    EXPECT_FALSE(found.identical);
    EXPECT_FALSE(found.layers[0].difference.identical);
    EXPECT_TRUE(found.layers[1].difference.identical);
    EXPECT_EQ(found.layers[1].flip, 0);
    EXPECT_FLOAT_EQ(found.layers[2].difference.mean_ratio.g, 2);
    EXPECT_GT(found.layers[2].flip, 0);
    EXPECT_EQ(found.flip_map.size(), 200u);
}

TEST(CompareLayers, NamesLayersThatOnlyOneHas) {
    const Picture reference = noisy_picture(8, 8);
    Picture picture = reference;
    picture.layers[2].name = "other";
    const Comparison found = compare_layers(reference, picture);
    EXPECT_THAT(found.only_in_reference, ElementsAre("a_node_whose_name_is_longer_than_31_letters"));
    EXPECT_THAT(found.only_in_picture, ElementsAre("other"));
    EXPECT_FALSE(found.identical) << "though the beauty is";
    EXPECT_TRUE(found.layers[0].difference.identical);
}

TEST(CompareLayers, FindsSamplesThatDiffer) {
    Picture reference = noisy_picture(8, 8);
    reference.samples.assign(64, 16);
    EXPECT_TRUE(compare_layers(reference, reference).identical);
    Picture picture = reference;
    picture.samples[5] = 32;
    EXPECT_FALSE(compare_layers(reference, picture).identical);
}

TEST(CompareLayers, SubtractsTheReference) {
    const Picture reference = noisy_picture(8, 8);
    Picture picture = reference;
    for (Rgb& colour : picture.layers[0].pixels) colour += Rgb{-1, 0, 2};
    picture.beauty[3] = reference.beauty[3] + Rgb{-1, 0, 2};
    picture.layers[1].name = "new";
    const Picture difference = difference_of(reference, picture);
    EXPECT_NEAR(difference.beauty[3].r, -1, 1e-4);
    EXPECT_EQ(difference.beauty[4], (Rgb{}));
    ASSERT_EQ(difference.layers.size(), 2u) << "those that both have";
    EXPECT_NEAR(difference.layers[0].pixels[7].b, 2, 1e-4);
    EXPECT_NEAR(without_signs(difference).beauty[3].r, 1, 1e-4);
    EXPECT_THROW(difference_of(reference, noisy_picture(8, 9)), Error);
}

// The colours that matplotlib gives for 0, 1/4, 1/2, 3/4 and 1.
TEST(CompareLayers, ShowsValuesAsColoursOfMagma) {
    const Rgb known[] = {{0.001f, 0.000f, 0.014f},
                         {0.317f, 0.072f, 0.485f},
                         {0.716f, 0.215f, 0.475f},
                         {0.987f, 0.536f, 0.382f},
                         {0.987f, 0.991f, 0.750f}};
    const Picture shown = magma_of(5, {0, 0.25f, 0.5f, 0.75f, 1});
    for (std::size_t i = 0; i < 5; ++i) {
        const auto curve = [](float c) {
            return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
        };
        EXPECT_NEAR(curve(shown.beauty[i].r), known[i].r, 0.025) << i;
        EXPECT_NEAR(curve(shown.beauty[i].g), known[i].g, 0.025) << i;
        EXPECT_NEAR(curve(shown.beauty[i].b), known[i].b, 0.025) << i;
    }
}

TEST(Compare, TakesWhatIsNoNumberForAsFarOffAsCanBe) {
    const Picture reference = noisy_picture(40, 40);
    Picture picture = reference;
    for (std::size_t i = 0; i < 5; ++i) picture.beauty[i * 7].g = std::numeric_limits<float>::quiet_NaN();
    const Difference found = compare(reference, picture);
    EXPECT_TRUE(std::isinf(found.relative_square));
    EXPECT_TRUE(std::isinf(found.relative_square_trimmed)) << "they are more than one in a thousand";
}

TEST(Compare, FindsTwoBlackPicturesEquallyBright) {
    const Picture black{8, 8, std::vector<Rgb>(64), {}};
    EXPECT_EQ(compare(black, black).mean_ratio, (Rgb{1, 1, 1}));
}

}  // namespace
}  // namespace lightnet::compare_layers_test
