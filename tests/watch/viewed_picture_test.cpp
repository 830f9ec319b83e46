// Finished pictures, as the page shows them.
#include "tools/watch/viewed_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "core/base/name_id.hpp"
#include "core/film/clean/clean.hpp"
#include "tests/film/pictures.hpp"
#include "tests/support/mistake.hpp"

namespace lightnet::viewed_picture_test {
namespace {

using test::mistake_of;
using testing::ElementsAre;
using testing::HasSubstr;

Picture two_layers(Rgb direct, Rgb bounce, std::uint32_t width = 4) {
    Picture picture;
    picture.width = width, picture.height = 3;
    const std::size_t pixels = std::size_t{width} * 3;
    picture.layers = {{"direct", std::vector<Rgb>(pixels, direct), {1, 1, 1}},
                      {"bounce", std::vector<Rgb>(pixels, bounce), {2, 2, 2}}};
    make_beauty(picture);
    return picture;
}

nlohmann::json hello_of(const ViewedPicture& viewed) {
    return nlohmann::json::parse(viewed.hello({}, Registry(std::vector<Kind>{})))["hello"];
}

// All colours of the first pixel on the board.
std::vector<float> first_pixel(const ViewedPicture& viewed) {
    WatchBoard::Seen seen;
    const auto frame = viewed.board()->pixels_since(seen, 1 << 20);
    std::vector<float> colours(viewed.board()->colours() * 3);
    std::memcpy(colours.data(), frame.data() + 12, colours.size() * sizeof(float));
    return colours;
}

TEST(ViewedPicture, HasTheLayersOfItsFileAndWhatThatSays) {
    Picture picture = two_layers({1, 2, 3}, {4, 5, 6});
    picture.shown = {{"depth", std::vector<Rgb>(12, Rgb{7, 7, 7}), {1, 1, 1}, letters_of_depths}};
    picture.alpha.assign(12, 0.5f);
    picture.notes.texts["samples"] = "64";
    ViewedPicture viewed({"x.exr", picture}, std::nullopt);
    viewed.show();
    const auto hello = hello_of(viewed);
    EXPECT_EQ(hello["viewed"], true);
    EXPECT_EQ(hello["samples"], 64);
    ASSERT_EQ(hello["colours"].size(), 4u);
    EXPECT_EQ(hello["colours"][1]["name"], "bounce");
    EXPECT_THAT(hello["colours"][1]["gain"], ElementsAre(2, 2, 2));
    EXPECT_EQ(hello["colours"][2]["fact"], true);
    EXPECT_EQ(hello["nodes"].size(), 0u);
    EXPECT_THAT(hello["facts"], ElementsAre(ElementsAre("size", "4 x 3"), ElementsAre("samples", "64")));
    EXPECT_THAT(first_pixel(viewed), ElementsAre(1, 2, 3, 4, 5, 6, 7, 7, 7, .5f, .5f, .5f));
}

TEST(ViewedPicture, HasOneLayerWhereItsFileHasNone) {
    Picture picture = two_layers({1, 2, 3}, {0, 0, 0});
    picture.layers.clear();
    ViewedPicture viewed({"x.exr", picture}, std::nullopt);
    viewed.show();
    EXPECT_EQ(hello_of(viewed)["colours"][0]["name"], "picture");
    EXPECT_THAT(first_pixel(viewed), ElementsAre(1, 2, 3));
}

TEST(ViewedPicture, StandsBesideAnotherLayerByLayer) {
    Picture other = two_layers({8, 8, 8}, {.5f, .5f, .5f});
    std::swap(other.layers[0], other.layers[1]);
    other.layers.push_back({"fog", std::vector<Rgb>(12, Rgb{1, 1, 1}), {1, 1, 1}});
    make_beauty(other);
    ViewedPicture viewed({"x.exr", two_layers({1, 1, 1}, {2, 2, 2})}, PictureFile{"y.exr", other});
    viewed.show();
    const auto hello = hello_of(viewed);
    EXPECT_EQ(hello["other"]["file"], "y.exr");
    EXPECT_EQ(hello["other"]["beauty"], 2);
    EXPECT_THAT(hello["other"]["colours"], ElementsAre(3, 4));
    EXPECT_TRUE(hello["other"]["gains"].is_null()) << "its layers are others";
    EXPECT_THAT(first_pixel(viewed), ElementsAre(1, 1, 1, 2, 2, 2, 10, 10, 10, 8, 8, 8, .5f, .5f, .5f));
}

TEST(ViewedPicture, MixesAnotherOfTheSameLayersByItsOwnGains) {
    ViewedPicture viewed({"x.exr", two_layers({1, 1, 1}, {2, 2, 2})},
                         PictureFile{"y.exr", two_layers({3, 3, 3}, {4, 4, 4})});
    EXPECT_THAT(hello_of(viewed)["other"]["gains"], ElementsAre(ElementsAre(1, 1, 1), ElementsAre(2, 2, 2)));
}

TEST(ViewedPicture, SaysWhichLayersAnotherLacks) {
    Picture other = two_layers({8, 8, 8}, {.5f, .5f, .5f});
    other.layers.pop_back();
    ViewedPicture viewed({"x.exr", two_layers({1, 1, 1}, {2, 2, 2})}, PictureFile{"y.exr", other});
    viewed.show();
    EXPECT_THAT(hello_of(viewed)["other"]["colours"], ElementsAre(3, -1));
    EXPECT_EQ(first_pixel(viewed).back(), 0);
}

TEST(ViewedPicture, ShowsNamesAsColoursByTheirShare) {
    Picture picture = two_layers({}, {});
    PictureMatte matte{"object", 2, std::vector<Covered>(24), "{}"};
    matte.pixels[0] = {name_id("floor"), 0.25f}, matte.pixels[1] = {name_id("wall"), 0.75f};
    matte.pixels[2] = {name_id("floor"), 1};
    matte.pixels[4] = {name_id("wall"), 1};
    picture.mattes = {matte};
    ViewedPicture viewed({"x.exr", picture}, std::nullopt);
    viewed.show();
    WatchBoard::Seen seen;
    const auto frame = viewed.board()->pixels_since(seen, 1 << 20);
    std::vector<Rgb> colours(9);
    std::memcpy(colours.data(), frame.data() + 12, colours.size() * sizeof(Rgb));
    const Rgb both = colours[2], floor = colours[5], wall = colours[8];
    EXPECT_NE(floor, wall);
    EXPECT_FLOAT_EQ(both.g, .25f * floor.g + .75f * wall.g);
}

TEST(ViewedPicture, IsCleanedWhereItHasWhatThatNeeds) {
    Picture picture = noisy_picture(40, 20);
    picture.shown.clear();
    for (const auto& layer : picture.layers) {
        auto half = layer;
        half.name = "half." + layer.name;
        for (Rgb& colour : half.pixels) colour *= 0.5f;
        picture.shown.push_back(half);
    }
    ViewedPicture viewed({"x.exr", picture}, std::nullopt);
    viewed.show();
    const auto first = hello_of(viewed)["cleaned"].get<std::size_t>();
    EXPECT_EQ(first_pixel(viewed)[first * 3], picture.layers[0].pixels[0].r) << "as it is, until it is cleaned";
    viewed.clean();
    EXPECT_EQ(first_pixel(viewed)[first * 3], clean(picture).picture.layers[0].pixels[0].r);
}

TEST(ViewedPicture, IsComparedWithNoneOfAnotherSize) {
    EXPECT_THAT(mistake_of([] {
                    ViewedPicture({"x.exr", two_layers({}, {})}, PictureFile{"y.exr", two_layers({}, {}, 5)});
                }),
                HasSubstr("y.exr: has 5 x 3 pixels from 0,0 on, where x.exr has 4 x 3 pixels"));
}

}  // namespace
}  // namespace lightnet::viewed_picture_test
