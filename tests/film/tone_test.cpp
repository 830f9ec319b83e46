// By which exposure a picture can be seen.
#include "core/film/tone.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lightnet::tone_test {
namespace {

// `share` of its pixels have the one value, the others the other.
Picture two_greys(double share, float one, float other) {
    Picture picture{100, 100, {}, {}};
    for (int i = 0; i < 10000; ++i) {
        const float value = i < share * 10000 ? one : other;
        picture.beauty.push_back({value, value, value});
    }
    return picture;
}

std::optional<double> stops_for(const Picture& picture) { return helpful_stops(brightness_of(picture)); }

TEST(Brightness, CountsWhatAPngCannotShow) {
    const auto found = brightness_of(two_greys(0.25, 2, 0.00001f));
    EXPECT_DOUBLE_EQ(found.clipped, 0.25);
    EXPECT_DOUBLE_EQ(found.black, 0.75);
    EXPECT_DOUBLE_EQ(found.lit, 1);
    Picture odd = two_greys(0, 0, 0);
    odd.beauty[0].g = std::numeric_limits<float>::quiet_NaN();
    EXPECT_DOUBLE_EQ(brightness_of(odd).black, 1) << "what is no number is black";
}

// 64 becomes 0.9 or a little less: log2(0.9 / 64) = -6.15.
TEST(Brightness, NamesTheExposureThatShowsAClippedPicture) {
    EXPECT_NEAR(stops_for(two_greys(0.9, 64, 0.1f)).value(), -6.2, 1e-9);
    EXPECT_EQ(stops_for(two_greys(0.4, 64, 0.1f)), std::nullopt) << "most of it can be seen";
    EXPECT_EQ(stops_for(two_greys(1, 1, 1)), std::nullopt) << "white paper is no mistake";
}

// 0.0001 becomes 0.5 or a little less: log2(0.5 / 0.0001) = 12.29.
TEST(Brightness, NamesTheExposureThatShowsADarkPicture) {
    EXPECT_NEAR(stops_for(two_greys(0.9, 0.0001f, 0)).value(), 12.2, 1e-9);
    EXPECT_EQ(stops_for(two_greys(0.2, 0.4f, 0)), std::nullopt) << "a thing on a black ground";
}

TEST(Brightness, KnowsWhenNoExposureHelps) {
    for (const double share : {0.0, 0.01}) {
        EXPECT_EQ(stops_for(two_greys(share, 0.4f, 0)), std::nullopt);
        EXPECT_TRUE(hardly_lit(brightness_of(two_greys(share, 0.4f, 0))));
    }
    EXPECT_FALSE(hardly_lit(brightness_of(two_greys(0.2, 0.4f, 0))));
    EXPECT_EQ(stops_for(two_greys(1, std::numeric_limits<float>::infinity(), 0)), std::nullopt);
}

TEST(PictureView, ChoosesAnExposureUnlessSomebodyHas) {
    const auto dark = brightness_of(two_greys(0.9, 0.0001f, 0));
    EXPECT_EQ(png_view(PictureView::automatic, dark), (PngView{*helpful_stops(dark)}));
    EXPECT_EQ(png_view(PictureView::automatic, dark, true), PngView{});
    EXPECT_EQ(png_view(PictureView::plain, dark), PngView{});
    EXPECT_EQ(png_view(PictureView::filmic, dark), (PngView{*helpful_stops(dark), Tone::filmic}));
    EXPECT_EQ(png_view(PictureView::automatic, brightness_of(two_greys(0.5, 0.2f, 0.8f))), PngView{})
        << "what can be seen stays as it is";
}

TEST(PngRequest, HasTheLastWordAboutTheExposure) {
    const auto dark = brightness_of(two_greys(0.9, 0.0001f, 0));
    PngRequest wanted = PictureView::filmic;
    wanted.stops = -1;
    wanted.alpha = true;
    for (const bool exposed : {false, true})
        EXPECT_EQ(png_view(wanted, dark, exposed), (PngView{-1, Tone::filmic, {}, true}));
    EXPECT_EQ(brightness_of(two_greys(0.25, 1, 0.00001f), 1).clipped, 0.25);
}

TEST(PictureView, GoesByName) {
    EXPECT_EQ(picture_view("auto"), PictureView::automatic);
    EXPECT_EQ(picture_view("plain"), PictureView::plain);
    EXPECT_EQ(picture_view("filmic"), PictureView::filmic);
    EXPECT_EQ(picture_view("linear"), std::nullopt);
}

}  // namespace
}  // namespace lightnet::tone_test
