// Words about fireflies name a graph that covers their paths, where the one that ran does not.
#include <gmock/gmock.h>

#include "tools/session/firefly_words.hpp"

namespace lightnet::firefly_words_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::uint32_t side = 64;

Picture picture_with(Rgb firefly, const char* layer) {
    Picture picture;
    picture.width = picture.height = side;
    picture.layers.push_back({layer, std::vector<Rgb>(side * side, Rgb{0.5f, 0.5f, 0.5f})});
    picture.layers[0].pixels[7 * side + 21] = firefly;
    return picture;
}

NodeReport node_of(const char* kind) {
    NodeReport node;
    node.name = "n", node.kind = kind;
    return node;
}

TEST(FireflyWords, NameTheGraphThatCoversWhatPathsMeetByChance) {
    const auto words = firefly_words(picture_with({900, 900, 900}, "bounce"), {node_of("PathTracing")}, "x.exr");
    EXPECT_THAT(words, HasSubstr("1 pixel holds 99 % of the noise"));
    EXPECT_THAT(words, HasSubstr("lightnet explain x.exr 21,7"));
    EXPECT_THAT(words, HasSubstr("graphs/progressive.lua"));
}

TEST(FireflyWords, NameNoGraphWherePhotonsAreThere) {
    const auto picture = picture_with({900, 900, 900}, "bounce");
    for (const char* kind : {"ProgressivePhotonMapping", "PhotonMap"})
        EXPECT_THAT(firefly_words(picture, {node_of("PathTracing"), node_of(kind)}, "x.exr"),
                    Not(HasSubstr("progressive.lua")));
}

TEST(FireflyWords, AreNoneOfLampsThatAreSeenOrOfPicturesWithoutFireflies) {
    EXPECT_EQ(firefly_words(picture_with({900, 900, 900}, "emission"), {node_of("PathTracing")}, "x.exr"), "");
    EXPECT_EQ(firefly_words(picture_with({0.5f, 0.5f, 0.5f}, "bounce"), {node_of("PathTracing")}, "x.exr"), "");
}

}  // namespace
}  // namespace lightnet::firefly_words_test
