// What a picture's file says of its numbers: windows, primaries, exposure, the order of rows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <tuple>

#include "core/base/error.hpp"
#include "core/readers/images/image_file.hpp"
#include "tests/support/memory_files.hpp"
#include "tests/support/picture_bytes.hpp"
#include "tests/support/picture_kinds.hpp"

namespace lightnet::image_meaning_test {
namespace {

using test::windowed_exr;
using testing::HasSubstr;

Image read(const std::string& bytes) { return read_image(*test::bytes_of(bytes)); }

void expect_near(Rgb found, Rgb wanted, float error) {
    EXPECT_NEAR(found.r, wanted.r, error);
    EXPECT_NEAR(found.g, wanted.g, error);
    EXPECT_NEAR(found.b, wanted.b, error);
}

TEST(Exr, ShowsItsDisplayWindow) {
    // data in the middle of it
    const Image small = read(windowed_exr({.data = {1, 1, 2, 2}, .display = {0, 0, 3, 3}}));
    ASSERT_EQ(small.width, 4u);
    ASSERT_EQ(small.height, 4u);
    EXPECT_EQ(small.colour(0, 0), (Rgb{0, 0, 0}));
    EXPECT_EQ(small.colour(3, 2), (Rgb{0, 0, 0}));
    EXPECT_EQ(small.colour(1, 2), (Rgb{201, 201.125f, 201.25f}));
    // more data than is shown
    const Image large = read(windowed_exr({.data = {-3, -2, 5, 4}, .display = {1, 1, 2, 2}}));
    ASSERT_EQ(large.width, 2u);
    EXPECT_EQ(large.colour(1, 0), (Rgb{102, 102.125f, 102.25f}));
    // some of either, and windows that begin below 0
    const Image shifted = read(windowed_exr({.data = {-6, -4, -3, -2}, .display = {-5, -3, -1, -1}}));
    ASSERT_EQ(shifted.width, 5u);
    ASSERT_EQ(shifted.height, 3u);
    EXPECT_EQ(shifted.colour(0, 0).r, -305);
    EXPECT_EQ(shifted.colour(2, 1).r, -203);
    EXPECT_EQ(shifted.colour(3, 0).r, 0);
    EXPECT_EQ(shifted.colour(0, 2).r, 0);
    // nothing of it
    EXPECT_EQ(read(windowed_exr({.data = {10, 10, 11, 11}})).colour(2, 1), (Rgb{0, 0, 0}));
}

TEST(Exr, OfACubeIsTheSkyAllAround) {
    for (const auto& [size, tiled] : {std::pair{2, false}, {33, false}, {33, true}}) {
        const Image image = read(test::cube_exr(size, tiled));
        ASSERT_EQ(image.width, 4u * unsigned(size));
        ASSERT_EQ(image.height, 2u * unsigned(size));
        const float error = size == 2 ? 0.45f : 0.003f;  // of what lies evenly between pixels
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width; ++x) {
                const float latitude = (0.5f - (float(y) + 0.5f) / float(image.height)) * float(M_PI);
                const float longitude = (1 - 2 * (float(x) + 0.5f) / float(image.width)) * float(M_PI);
                const float flat = std::cos(latitude);
                expect_near(image.colour(x, y),
                            {2 + flat * std::sin(longitude), 2 + std::sin(latitude), 2 + flat * std::cos(longitude)},
                            error);
            }
    }
}

TEST(Exr, OfACubeHasSixSquareFaces) {
    const Image one = read(
        windowed_exr({.channels = {"R", "G", "B", "A"}, .data = {3, 0, 3, 5}, .display = {0, 0, 9, 9}, .envmap = 1}));
    ASSERT_EQ(one.width, 4u);
    ASSERT_EQ(one.height, 2u);
    EXPECT_TRUE(one.has_alpha());
    try {
        read(windowed_exr({.envmap = 1}));
        FAIL() << "two rows are no cube";
    } catch (const Error& problem) {
        EXPECT_THAT(problem.what(), HasSubstr("not 3 x 2 pixels"));
    }
    EXPECT_EQ(read(windowed_exr({.envmap = 0})).colour(2, 1), (Rgb{102, 102.125f, 102.25f}));
}

TEST(Exr, IsTransparentWhereThereIsNoData) {
    const Image image = read(windowed_exr({.channels = {"R", "G", "B", "A"}, .data = {1, 0, 2, 1}}));
    ASSERT_TRUE(image.has_alpha());
    EXPECT_EQ(image.alpha(0, 1), 0);
    EXPECT_EQ(image.alpha(1, 0), 1.375f);
}

TEST(Exr, TakesOneChannelOfAnyNameAsGrey) {
    for (const char* name : {"Z", "G", "R", "mask", "depth.Z"}) {
        const Image image = read(windowed_exr({.channels = {name}}));
        EXPECT_EQ(image.colour(2, 1), (Rgb{102, 102, 102})) << name;
    }
    EXPECT_TRUE(read(windowed_exr({.channels = {"Z", "A"}})).has_alpha());
}

TEST(Exr, KnowsColoursByTheirLettersAndWords) {
    for (const char* layer : {"", "beauty.", "rgba."})
        for (const auto& [red, green, blue] :
             {std::tuple{"r", "g", "b"}, {"red", "green", "blue"}, {"Red", "Green", "Blue"}}) {
            const std::string in(layer);
            const Image image = read(windowed_exr({.channels = {in + red, in + green, in + blue, in + "depth"}}));
            EXPECT_EQ(image.colour(1, 0), (Rgb{1, 1.125f, 1.25f})) << layer << red;
        }
    // big letters before small ones
    EXPECT_EQ(read(windowed_exr({.channels = {"r", "g", "b", "R", "G", "B"}})).colour(1, 0).r, 1.375f);
}

TEST(Exr, ShowsTheFirstLayerThatHasColours) {
    const Image image = read(windowed_exr({.channels = {"left.R", "left.G", "left.B", "left.A", "depth.Z"}}));
    EXPECT_EQ(image.colour(1, 0), (Rgb{1, 1.125f, 1.25f}));
    EXPECT_TRUE(image.has_alpha());
    EXPECT_EQ(read(test::parts_exr()).colour(1, 0), (Rgb{1, 1.125f, 1.25f}));
}

TEST(Exr, TurnsOtherPrimariesIntoOurs) {
    const std::vector<float> xyz{1, 0, 0, 1, 0, 0, 1 / 3.0f, 1 / 3.0f};
    const Image absolute = read(windowed_exr({.chromaticities = xyz}));
    // X, Y, Z of 1, 1.125, 1.25 are that light in Rec. 709, whatever the white
    expect_near(
        absolute.colour(1, 0),
        {3.240970f - 1.537383f * 1.125f - 0.498611f * 1.25f, -0.969244f + 1.875968f * 1.125f + 0.041555f * 1.25f,
         0.055630f - 0.203977f * 1.125f + 1.056972f * 1.25f},
        1e-3f);
    expect_near(read(windowed_exr({.channels = {"X", "Y", "Z"}})).colour(1, 0), absolute.colour(1, 0), 1e-5f);
    // of other primaries, white stays white: ACES AP0 with white D60
    const std::vector<float> aces{0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f};
    const Rgb grey =
        read(windowed_exr({.data = {0, 8, 0, 8}, .display = {0, 8, 0, 8}, .chromaticities = aces})).colour(0, 0);
    expect_near(grey, {800, 800, 800}, 1);
    // Rec. 2020 has our white
    const std::vector<float> wide{0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f};
    const Rgb turned = read(windowed_exr({.chromaticities = wide})).colour(1, 0);
    expect_near(
        turned,
        {1.660491f - 0.587641f * 1.125f - 0.072850f * 1.25f, -0.124550f + 1.132900f * 1.125f - 0.008349f * 1.25f,
         -0.018151f - 0.100579f * 1.125f + 1.118730f * 1.25f},
        1e-3f);
}

TEST(Exr, LeavesItsOwnPrimariesAndSenselessOnesAsTheyAre) {
    const Rgb plain = read(windowed_exr({})).colour(2, 1);
    for (const auto& n : {std::vector<float>{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f},
                          std::vector<float>(8, 0.0f), std::vector<float>(8, 0.3f)})
        EXPECT_EQ(read(windowed_exr({.chromaticities = n})).colour(2, 1), plain);
}

TEST(Exr, FillsInColoursOfFewerPixels) {
    const Image image = read(test::chroma_exr(0.6f, 0.3f, 0.1f));
    ASSERT_EQ(image.width, 16u);
    for (const std::uint32_t x : {0u, 7u, 15u})
        for (const std::uint32_t y : {0u, 5u, 11u}) expect_near(image.colour(x, y), {0.6f, 0.3f, 0.1f}, 0.005f);
}

/// Three pixels across and two down: in red their number, from 1.
std::string numbered_hdr(const std::string& size, const std::vector<int>& numbers, const std::string& header = "") {
    std::string text = "#?RADIANCE\n" + header + "\n" + size + "\n";
    for (const int number : numbers) text += std::string{char(16 * number), 0, 0, char(132)};
    return text;
}

TEST(Hdr, IsReadInAllOrdersOfItsRows) {
    const std::pair<const char*, std::vector<int>> orders[] = {
        {"-Y 2 +X 3", {1, 2, 3, 4, 5, 6}}, {"-Y 2 -X 3", {3, 2, 1, 6, 5, 4}}, {"+Y 2 +X 3", {4, 5, 6, 1, 2, 3}},
        {"+Y 2 -X 3", {6, 5, 4, 3, 2, 1}}, {"+X 3 -Y 2", {1, 4, 2, 5, 3, 6}}, {"+X 3 +Y 2", {4, 1, 5, 2, 6, 3}},
        {"-X 3 -Y 2", {3, 6, 2, 5, 1, 4}}, {"-X 3 +Y 2", {6, 3, 5, 2, 4, 1}}};
    for (const auto& [size, numbers] : orders) {
        const Image image = read(numbered_hdr(size, numbers));
        ASSERT_EQ(image.width, 3u) << size;
        ASSERT_EQ(image.height, 2u) << size;
        for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(image.colour(i % 3, i / 3).r, float(i + 1)) << size;
    }
    for (const char* wrong : {"-Y 2 +Y 3", "-Z 2 +X 3", "2 3", "-Y 2"}) {
        EXPECT_THROW(read(numbered_hdr(wrong, {1, 2, 3, 4, 5, 6})), Error) << wrong;
    }
}

TEST(Hdr, TakesExposureBack) {
    const auto red = [](const std::string& header) {
        return read(numbered_hdr("-Y 1 +X 1", {2}, header)).colour(0, 0).r;
    };
    EXPECT_EQ(red(""), 2);
    EXPECT_EQ(red("EXPOSURE=4\n"), 0.5f);
    EXPECT_EQ(red("EXPOSURE= 4.0\r\nFORMAT=32-bit_rle_rgbe\r\nEXPOSURE=0.5\r\n"), 1);
    EXPECT_EQ(red("COLORCORR= 8 1 1\n"), 0.25f);
    EXPECT_EQ(red("EXPOSURE=0\nEXPOSURE=none\n"), 2);
}

TEST(Hdr, TakesXyzAndOtherPrimariesForWhatTheyAre) {
    const std::string data("\x80\x80\x80\x81", 4);
    const auto with = [&](const std::string& header) {
        return read("#?RADIANCE\n" + header + "\n-Y 1 +X 1\n" + data).colour(0, 0);
    };
    expect_near(with("FORMAT=32-bit_rle_xyze\n"), {1.2048f, 0.9483f, 0.9086f}, 1e-3f);
    expect_near(with("PRIMARIES=.64 .33 .29 .6 .15 .06 .333 .333\n"), {1, 1, 1}, 2e-3f);
    EXPECT_THROW(with("FORMAT=32-bit_rle_lab\n"), Error);
}

TEST(Tiff, IsNotTurned) {
    for (int turned = 1; turned <= 8; ++turned)
        EXPECT_EQ(read(test::palette_tiff(turned)).colour(0, 0), (Rgb{1, 0, 0})) << turned;
}

// Ward Larson 1998, "Overcoming Gamut and Dynamic Range Limitations in Digital Images": brightness is kept to 0.3 % (24
// bits: 1.1 %), colours to 1/410 (about 1/300) of the whole of u' and v'.
TEST(Tiff, MayHoldLogarithmsOfBrightness) {
    const std::vector<float> xyz{0.9505f * 8, 8, 1.089f * 8, 0.4124f * 0.01f, 0.2126f * 0.01f, 0.0193f * 0.01f};
    for (const int compression : {34676, 34677}) {
        const Image image = read(test::log_tiff(compression, xyz));
        ASSERT_EQ(image.width, 2u);
        expect_near(image.colour(0, 0) * (1 / 8.0f), {1, 1, 1}, 0.05f);
        expect_near(image.colour(1, 0) * 100, {1, 0, 0}, 0.05f);
    }
    const Image grey = read(test::log_tiff(34676, {300, 0.01f}));
    expect_near(grey.colour(0, 0) * (1 / 300.0f), {1, 1, 1}, 0.004f);
    expect_near(grey.colour(1, 0) * 100, {1, 1, 1}, 0.004f);
}

TEST(Png, OfGreyAndAlphaMayHaveSixteenBits) {
    const std::uint16_t samples[] = {0x2000, 0x4000, 0xFFFF, 0xFFFF};  // grey times alpha, alpha
    const Image image = read(test::png(PNG_FORMAT_LINEAR_Y_ALPHA, samples));
    EXPECT_NEAR(image.alpha(0, 0), 0x4000 / 65535.0f, 1e-6f);
    EXPECT_EQ(image.alpha(1, 0), 1);
    const float value = 0.5f;
    expect_near(image.colour(0, 0), Rgb{1, 1, 1} * std::pow((value + 0.055f) / 1.055f, 2.4f), 1e-4f);
}

// What programs that show pictures would do, glTF and all renderers don't.
TEST(Png, MeansTheSameWhateverItSaysOfGamma) {
    std::string png = test::small_png();
    const Rgb plain = read(png).colour(0, 0);
    const std::string chunk = std::string("\0\0\0\4gAMA\0\1\x86\xA0", 12) + std::string("\x31\xE8\x96\x5F", 4);
    png.insert(33, chunk);  // gamma 1, behind the header
    EXPECT_EQ(read(png).colour(0, 0), plain);
}

}  // namespace
}  // namespace lightnet::image_meaning_test
