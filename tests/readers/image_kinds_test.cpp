// The rarer kinds of pictures, each pixel of which is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/readers/images/image_file.hpp"
#include "tests/support/memory_files.hpp"
#include "tests/support/picture_kinds.hpp"

namespace lightnet::image_kinds_test {
namespace {

using test::Wheel;
using testing::HasSubstr;

constexpr Encoding linear{Encoding::Curve::linear, 1};

Image read(const std::string& bytes) { return read_image(*test::bytes_of(bytes), linear); }

std::string error_of(const std::string& bytes) {
    try {
        read(bytes);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

/// Does it show the wheel, within that much of 255?
void expect_wheel(const std::string& bytes, const std::string& what, int channels = 3, float error = 0) {
    const Image image = read(bytes);
    ASSERT_EQ(image.width, Wheel::width) << what;
    ASSERT_EQ(image.height, Wheel::height) << what;
    const auto all = Wheel::bytes(4);
    EXPECT_EQ(image.has_alpha(), channels == 4) << what;
    for (std::uint32_t i = 0; i < 6; ++i) {
        const Rgb found = image.colour(i % 3, i / 3) * 255;
        EXPECT_NEAR(found.r, all[4 * i], error + 1e-3f) << what << ", pixel " << i;
        EXPECT_NEAR(found.g, all[4 * i + 1], error + 1e-3f) << what << ", pixel " << i;
        EXPECT_NEAR(found.b, all[4 * i + 2], error + 1e-3f) << what << ", pixel " << i;
        if (channels == 4) {
            EXPECT_NEAR(image.alpha(i % 3, i / 3) * 255, all[4 * i + 3], error + 1e-3f) << what;
        }
    }
}

TEST(Bmp, IsReadFromEitherEndPackedOrNot) {
    for (const int bits : {4, 8, 24, 32})
        for (const bool from_top : {false, true})
            expect_wheel(test::bmp(bits, from_top, false), std::to_string(bits) + " bits");
    expect_wheel(test::bmp(16, false, false), "15 bits", 3, 8);
    for (const int bits : {4, 8}) expect_wheel(test::bmp(bits, false, true), "runs of " + std::to_string(bits));
    expect_wheel(test::bmp(32, true, true), "masks", 4);
    const Image bits = read(test::bmp(1, false, false));
    EXPECT_EQ(bits.colour(0, 1), (Rgb{1, 1, 1}));
    EXPECT_EQ(bits.colour(2, 1), (Rgb{0, 0, 0}));
}

TEST(Bmp, IsRefusedWhereItIsTooShortOrStrange) {
    const auto whole = test::bmp(24, false, false);
    EXPECT_THAT(error_of(whole.substr(0, whole.size() - 4)), HasSubstr("BMP: the file ends early"));
    auto strange = whole;
    strange[28] = 23;
    EXPECT_THAT(error_of(strange), HasSubstr("BMP: pixels of that kind"));
}

TEST(Netpbm, IsReadInLettersAndInBytes) {
    for (const char kind : {'3', '6'}) expect_wheel(test::netpbm(kind), std::string("P") + kind);
    expect_wheel(test::netpbm('7'), "PAM", 4);
    expect_wheel(test::netpbm('6', 65535), "16 bits");
    expect_wheel(test::netpbm('3', 100), "up to 100", 3, 2);
    for (const char kind : {'2', '5'}) {
        const Image grey = read(test::netpbm(kind));
        EXPECT_EQ(grey.colour(0, 0), (Rgb{1, 1, 1})) << kind;
        EXPECT_EQ(grey.colour(1, 0), (Rgb{0, 0, 0})) << kind;
    }
    for (const char kind : {'1', '4'}) {  // black is 1
        const Image bits = read(test::netpbm(kind));
        EXPECT_EQ(bits.colour(0, 0), (Rgb{0, 0, 0})) << kind;
        EXPECT_EQ(bits.colour(1, 0), (Rgb{1, 1, 1})) << kind;
        EXPECT_EQ(bits.colour(1, 1), (Rgb{0, 0, 0})) << kind;
    }
    EXPECT_THAT(error_of("P6\n3 2\n255\nabc"), HasSubstr("PNM: the file ends early"));
    EXPECT_THAT(error_of("P3\n1 1\n255\n1 2 x"), HasSubstr("a whole number expected, not 'x'"));
    EXPECT_THAT(error_of("P6\n100000 100000\n255\nabc"), HasSubstr("too large"));
}

TEST(Pfm, IsReadInBothOrdersOfBytesFromTheLowestRow) {
    for (const float scale : {-1.0f, 1.0f}) expect_wheel(test::pfm(true, scale), "PFM");
    EXPECT_NEAR(read(test::pfm(true, -2.5f)).colour(1, 1).g, 2.5f * 128 / 255, 1e-5f);
    const Image grey = read(test::pfm(false, 1));
    EXPECT_EQ(grey.colour(0, 0), (Rgb{1, 1, 1}));
    EXPECT_EQ(grey.colour(2, 1), (Rgb{0, 0, 0}));
    EXPECT_THAT(error_of("PF\n1 1\n0\n123456789012"), HasSubstr("PFM: a number but 0"));
}

TEST(WebP, IsReadWithAndWithoutLoss) {
    expect_wheel(test::webp(true, false), "lossless");
    expect_wheel(test::webp(true, true), "lossless, with alpha", 4);
    // colours of four pixels are one: grey in the middle of the lower row is the mean of its neighbours
    const Image lossy = read(test::webp(false, false));
    EXPECT_NEAR(lossy.colour(0, 1).g, 1, 0.2f);
    EXPECT_NEAR(lossy.colour(2, 1).g, 0, 0.2f);
    EXPECT_THAT(error_of(test::webp(true, false).substr(0, 30)), HasSubstr("WebP: the file is broken, or ends early"));
}

TEST(Gif, ShowsItsFirstPicture) {
    for (const bool interlaced : {false, true}) {
        const Image image = read(test::gif(interlaced));
        ASSERT_EQ(image.width, Wheel::width);
        EXPECT_EQ(image.colour(0, 0), (Rgb{1, 0, 0}));
        EXPECT_EQ(image.colour(1, 0), (Rgb{0, 1, 0}));
        EXPECT_EQ(image.colour(0, 1), (Rgb{1, 1, 1}));
        EXPECT_NEAR(image.colour(1, 1).r, 128 / 255.0f, 1e-6f);
        EXPECT_EQ(image.alpha(2, 0), 0);
        EXPECT_EQ(image.alpha(1, 0), 1);
    }
    EXPECT_THAT(error_of(test::gif(false).substr(0, 60)), HasSubstr("GIF: "));
}

TEST(Jpeg, TakesInksAsEachLetsLightThrough) {
    for (const bool adobe : {false, true}) {
        const Image image = read(test::cmyk_jpeg(255, 128, 0, 51, adobe));
        ASSERT_EQ(image.width, 8u);
        EXPECT_NEAR(image.colour(3, 3).r, 0, 0.02f) << adobe;
        EXPECT_NEAR(image.colour(3, 3).g, 0.8f * 127 / 255, 0.02f) << adobe;
        EXPECT_NEAR(image.colour(3, 3).b, 0.8f, 0.02f) << adobe;
        EXPECT_FALSE(image.has_alpha());
    }
}

std::string level(int channels) {
    const auto bytes = Wheel::bytes(channels);
    return {bytes.begin(), bytes.end()};
}

TEST(Ktx, IsReadPlainAndPacked) {
    for (const std::uint32_t packing : {0u, 2u, 3u}) {
        expect_wheel(test::ktx({.format = 29, .packing = packing}, level(3)), "sRGB");
        expect_wheel(test::ktx({.format = 37, .packing = packing}, level(4)), "RGBA", 4);
    }
    const std::string bgr = test::ktx({.format = 30, .width = 1, .height = 1}, "\x33\x66\xff");
    EXPECT_EQ(read(bgr).colour(0, 0), (Rgb{1, 0.4f, 0.2f}));
    const std::string wide = test::ktx({.format = 70, .width = 1, .height = 1}, std::string("\x34\x12", 2));
    EXPECT_NEAR(read(wide).colour(0, 0).g, 0x1234 / 65535.0f, 1e-6f);
    const std::string halves = test::ktx({.format = 83, .width = 1, .height = 1}, std::string("\0\x3c\0\x42", 4));
    EXPECT_EQ(read(halves).colour(0, 0), (Rgb{1, 3, 0}));
    const std::string floats = test::ktx({.format = 100, .width = 1, .height = 1}, std::string("\0\0\x20\x41", 4));
    EXPECT_EQ(read(floats).colour(0, 0), (Rgb{10, 10, 10}));
}

// 5 x 1 pixels, of which the second block holds the last: red, blue, and what lies between
TEST(Ktx, MayBeOfBlocks) {
    const std::string red("\x00\xf8", 2), blue("\x1f\x00", 2), steps("\xe4\0\0\0", 4), none(8, '\0');
    const auto of = [](std::uint32_t format, const std::string& blocks, std::uint32_t packing = 0) {
        return read(test::ktx({.format = format, .width = 5, .height = 1, .packing = packing}, blocks));
    };
    for (const std::uint32_t packing : {0u, 2u}) {
        const Image four = of(131, red + blue + steps + blue + red + std::string(4, '\0'), packing);
        EXPECT_EQ(four.colour(0, 0), (Rgb{1, 0, 0}));
        EXPECT_EQ(four.colour(1, 0), (Rgb{0, 0, 1}));
        EXPECT_NEAR(four.colour(2, 0).r, 2 / 3.0f, 1e-5f);
        EXPECT_NEAR(four.colour(3, 0).b, 2 / 3.0f, 1e-5f);
        EXPECT_EQ(four.colour(4, 0), (Rgb{0, 0, 1}));
    }
    const Image three = of(133, blue + red + steps + none);  // the first is not above the second
    EXPECT_NEAR(three.colour(2, 0).r, 128 / 255.0f, 1e-5f);
    EXPECT_EQ(three.alpha(3, 0), 0);
    EXPECT_EQ(three.alpha(2, 0), 1);
    const std::string alphas("\x10\xf2", 2);  // 0, 1, 2 and 15 of 15
    const Image bc2 = of(135, alphas + std::string(6, '\0') + red + blue + steps + none + none);
    EXPECT_NEAR(bc2.alpha(1, 0), 1 / 15.0f, 1e-5f);
    EXPECT_NEAR(bc2.alpha(3, 0), 1, 1e-5f);
    // 140 and 0: pixels 0 … 3 are the first, the second, 6/7 and 1/7 of the first
    const std::string numbers("\x8c\0\x88\x0e\0\0\0\0", 8);
    const Image bc3 = of(137, numbers + red + blue + steps + none + none);
    EXPECT_NEAR(bc3.alpha(0, 0), 140 / 255.0f, 1e-5f);
    EXPECT_NEAR(bc3.alpha(1, 0), 0, 1e-5f);
    EXPECT_NEAR(bc3.alpha(2, 0), 120 / 255.0f, 1e-5f);
    EXPECT_NEAR(bc3.alpha(3, 0), 20 / 255.0f, 1e-5f);
    const Image bc4 = of(139, numbers + none);
    EXPECT_NEAR(bc4.colour(2, 0).b, 120 / 255.0f, 1e-5f);
    const Image bc5 = of(141, numbers + std::string("\xff", 1) + std::string(7, '\0') + none + none);
    EXPECT_NEAR(bc5.colour(2, 0).r, 120 / 255.0f, 1e-5f);
    EXPECT_EQ(bc5.colour(2, 0).g, 1);
    EXPECT_EQ(bc5.colour(2, 0).b, 0);
    EXPECT_THAT(error_of(test::ktx({.format = 131, .width = 5, .height = 1}, none)), HasSubstr("ends early"));
}

TEST(Ktx, SaysWhichRowIsTheFirst) {
    const std::string up("\x12\0\0\0KTXorientation\0ru\0\0\0", 24);
    const Image image = read(test::ktx({.keys = up}, level(3)));
    EXPECT_EQ(image.colour(0, 1), (Rgb{1, 0, 0}));
    EXPECT_EQ(image.colour(0, 0), (Rgb{1, 1, 1}));
}

TEST(Ktx, NamesWhatItCantUnpack) {
    EXPECT_THAT(error_of(test::ktx({.format = 0, .packing = 1}, "x")), HasSubstr("Basis Universal"));
    EXPECT_THAT(error_of(test::ktx({.format = 145}, "x")), HasSubstr("Vulkan's format 145"));
    EXPECT_THAT(error_of(test::ktx({.format = 29}, "x")), HasSubstr("KTX: the file ends early"));
}

TEST(Pictures, OfKnownKindsThatAreNotReadAreNamed) {
    EXPECT_THAT(error_of("DDS |............................................................"),
                HasSubstr("images of the format DDS are not supported"));
    EXPECT_THAT(error_of(std::string("\0\0\0\x1c", 4) + "ftypavif...................................."),
                HasSubstr("AVIF"));
    EXPECT_THAT(error_of("<html>"), HasSubstr("not an image of a known format (JPEG, PNG"));
}

}  // namespace
}  // namespace lightnet::image_kinds_test
