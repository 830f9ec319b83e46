#include "core/scene/surfaces/textures.hpp"

#include <gtest/gtest.h>

namespace lightnet::textures_test {
namespace {

// red   green
// blue  white
Texture four_pixels() {
    ImageTexture picture;
    picture.image = std::make_shared<const Image>(2, 2, std::vector<Rgb>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
    Texture texture;
    texture.pattern = picture;
    return texture;
}

ImageTexture& picture_of(Texture& texture) { return std::get<ImageTexture>(texture.pattern); }

Rgb look_up(const Texture& texture, Vec2 uv) { return lightnet::look_up({&texture, 1}, 0, {uv, {1, 1, 1}}); }

TEST(Texture, CountsRowsFromTheBottom) {
    const Texture texture = four_pixels();
    EXPECT_EQ(look_up(texture, {0.25f, 0.75f}), (Rgb{1, 0, 0}));
    EXPECT_EQ(look_up(texture, {0.75f, 0.75f}), (Rgb{0, 1, 0}));
    EXPECT_EQ(look_up(texture, {0.25f, 0.25f}), (Rgb{0, 0, 1}));
}

TEST(Texture, MixesNeighbours) {
    EXPECT_EQ(look_up(four_pixels(), {0.5f, 0.75f}), (Rgb{0.5f, 0.5f, 0}));
    EXPECT_EQ(look_up(four_pixels(), {0.5f, 0.5f}), (Rgb{0.5f, 0.5f, 0.5f}));
}

TEST(Texture, WrapsAsItIsTold) {
    Texture texture = four_pixels();
    EXPECT_EQ(look_up(texture, {-0.75f, 3.75f}), (Rgb{1, 0, 0}));
    picture_of(texture).wrap_u = picture_of(texture).wrap_v = Wrap::clamp;
    EXPECT_EQ(look_up(texture, {-7, 9}), (Rgb{1, 0, 0}));
    picture_of(texture).wrap_u = picture_of(texture).wrap_v = Wrap::black;
    EXPECT_EQ(look_up(texture, {-7, 9}), (Rgb{0, 0, 0}));
    EXPECT_EQ(look_up(texture, {0.25f, 0.75f}), (Rgb{1, 0, 0}));
}

TEST(Texture, ScalesColoursAndCoordinates) {
    Texture texture = four_pixels();
    texture.scale = {2, 2, 2};
    picture_of(texture).uv.scale = {2, 1};
    picture_of(texture).uv.offset = {0.5f, 0};
    EXPECT_EQ(look_up(texture, {0.125f, 0.75f}), (Rgb{0, 2, 0}));
}

TEST(Texture, InvertsToWhatIsMissingFromOne) {
    Texture texture;
    texture.scale = {0.2f, 1, 3};
    texture.invert = true;
    EXPECT_EQ(look_up(texture, {}), (Rgb{0.8f, 0, 0}));
}

TEST(Texture, SurvivesWildCoordinates) {
    for (const float wild : {1e30f, -1e30f, std::numeric_limits<float>::infinity(), std::nanf("")})
        EXPECT_TRUE(finite(look_up(four_pixels(), {wild, wild})));
}

}  // namespace
}  // namespace lightnet::textures_test
