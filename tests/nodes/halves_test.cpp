// Halves of the samples, which a renderer keeps for cleaning.
#include <gmock/gmock.h>

#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::halves_test {
namespace {

using namespace test;

// A floor, half in the shadow of a screen, under a lamp that is seen, too.
SceneData shadowed() {
    SceneData data;
    add(data, quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), diffuse(data, 0.6f));
    add(data, quad({-1, 1, -1}, {0, 0, 2}, {1, 0, 0}), diffuse(data, 0.3f));
    data.camera = camera({0, 2, 4}, {0, 0, 0}, 60);
    data.camera_given = true;
    return data;
}

SmallNetwork lit() {
    SmallNetwork network(shadowed(), 12, 10);
    network.add("sky", "AmbientOcclusion").lit_by("sky");
    return network;
}

double mean_of(const std::vector<Rgb>& pixels) {
    double sum = 0;
    for (const auto& pixel : pixels) sum += pixel.g;
    return sum / double(pixels.size());
}

TEST(Halves, ChangeNoLayer) {
    const auto without = lit().pictures(20), with = lit().for_cleaning().pictures(20);
    for (const auto& [name, pixels] : without) EXPECT_EQ(with.at(name), pixels) << name;
    EXPECT_FALSE(without.contains("half.sky"));
    for (const char* name : {"half.sky", "half.emission", "clean_albedo", "half.clean_albedo", "clean_normal",
                             "half.clean_normal", "clean_depth", "half.clean_depth"})
        EXPECT_TRUE(with.contains(name)) << name;
}

TEST(Halves, AreHalfOfTheLightWhateverTheNumberOfSamples) {
    for (const std::uint32_t samples : {1u, 2u, 3u, 16u, 17u, 32u, 43u}) {
        const auto pictures = lit().for_cleaning().pictures(samples);
        EXPECT_NEAR(mean_of(pictures.at("half.sky")) / mean_of(pictures.at("sky")), 0.5, samples < 16 ? 0.06 : 0.02)
            << samples << " samples";
        EXPECT_NEAR(mean_of(pictures.at("half.clean_depth")) / mean_of(pictures.at("clean_depth")), 0.5, 0.06);
    }
}

TEST(Halves, OfOneSampleAreBothTheWhole) {
    const auto pictures = lit().for_cleaning().pictures(1);
    for (std::size_t i = 0; i < pictures.at("sky").size(); ++i)
        EXPECT_EQ(pictures.at("half.sky")[i], 0.5f * pictures.at("sky")[i]);
}

TEST(Halves, HaveNoiseOfTheirOwn) {
    const auto pictures = lit().for_cleaning().pictures(16);
    const auto &all = pictures.at("sky"), &second = pictures.at("half.sky");
    std::size_t differ = 0;
    for (std::size_t i = 0; i < all.size(); ++i) differ += all[i] != 2 * second[i];
    EXPECT_GT(differ, all.size() / 10);
}

}  // namespace
}  // namespace lightnet::halves_test
