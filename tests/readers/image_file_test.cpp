#include "core/readers/images/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <cstdint>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "tests/support/memory_files.hpp"
#include "tests/support/picture_bytes.hpp"
#include "tests/support/picture_kinds.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::image_file_test {
namespace {

using test::exr, test::hdr, test::jpeg, test::png, test::small_png;
using testing::HasSubstr;

Image read(const std::string& bytes, const Encoding& encoding = {}) {
    return read_image(*test::bytes_of(bytes), encoding);
}

std::string error_of(const std::string& bytes) {
    try {
        read(bytes);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Png, TurnsEightBitsIntoLight) {
    const Image image = read(small_png());
    ASSERT_EQ(image.width, 2u);
    ASSERT_EQ(image.height, 1u);
    EXPECT_EQ(image.colour(0, 0).r, 1);
    EXPECT_EQ(image.colour(0, 0).g, 0);
    EXPECT_NEAR(image.colour(0, 0).b, 0.5029f, 1e-3f);  // sRGB 188 is half the light
    EXPECT_FALSE(image.has_alpha());
}

TEST(Png, TakesNumbersAsTheyAreWhenTheyAreLinear) {
    EXPECT_NEAR(read(small_png(), {Encoding::Curve::linear, 1}).colour(1, 0).b, 128 / 255.0f, 1e-6f);
    EXPECT_NEAR(read(small_png(), {Encoding::Curve::gamma, 2}).colour(1, 0).b, std::pow(128 / 255.0f, 2.0f), 1e-6f);
}

TEST(Png, ReadsSixteenBits) {
    const std::uint16_t samples[] = {65535, 0, 32768, 0, 1, 65535};
    const Image image = read(png(PNG_FORMAT_LINEAR_RGB, samples), {Encoding::Curve::linear, 1});
    EXPECT_EQ(image.colour(0, 0).r, 1);
    EXPECT_NEAR(image.colour(0, 0).b, 32768 / 65535.0f, 1e-6f);
    EXPECT_NEAR(image.colour(1, 0).g, 1 / 65535.0f, 1e-7f);
}

TEST(Png, TakesNoMoreMemoryThanItsNumbers) {
    const std::uint16_t wide[] = {65535, 0, 32768, 0, 1, 65535};
    const std::uint8_t grey[] = {255, 0};
    EXPECT_EQ(read(small_png()).memory(), 6u);
    EXPECT_EQ(read(png(PNG_FORMAT_LINEAR_RGB, wide)).memory(), 12u);
    EXPECT_EQ(read(png(PNG_FORMAT_GRAY, grey)).memory(), 2u);
}

TEST(Png, KeepsAlphaLinear) {
    const std::uint8_t samples[] = {255, 255, 255, 128, 0, 0, 0, 255};
    const Image image = read(png(PNG_FORMAT_RGBA, samples));
    ASSERT_TRUE(image.has_alpha());
    EXPECT_NEAR(image.alpha(0, 0), 128 / 255.0f, 1e-6f);
    EXPECT_EQ(image.alpha(1, 0), 1);
}

TEST(Png, SpreadsGreyOverAllColours) {
    const std::uint8_t samples[] = {255, 0};
    const Image image = read(png(PNG_FORMAT_GRAY, samples));
    EXPECT_EQ(image.colour(0, 0), (Rgb{1, 1, 1}));
    EXPECT_EQ(image.colour(1, 0), (Rgb{0, 0, 0}));
}

TEST(Jpeg, TurnsEightBitsIntoLight) {
    for (const int channels : {1, 3}) {
        const Image image = read(jpeg(188, channels));
        ASSERT_EQ(image.width, 16u);
        ASSERT_EQ(image.height, 8u);
        EXPECT_NEAR(image.colour(2, 3).g, 0.5029f, 0.006f);
    }
}

TEST(Exr, ReadsFloatsFromTheTop) {
    const Image image = read(exr({"R", "G", "B", "A"}));
    ASSERT_EQ(image.width, 3u);
    ASSERT_EQ(image.height, 2u);
    EXPECT_EQ(image.colour(0, 0), (Rgb{0.25f, 1.25f, 2.25f}));
    EXPECT_EQ(image.colour(2, 1), (Rgb{1000, 1001, 1002}));
    EXPECT_EQ(image.alpha(0, 1), 6);
}

TEST(Exr, MayBeCutIntoTilesWithSmallerLevels) {
    const Image image = read(test::tiled_exr());
    ASSERT_EQ(image.width, 70u);
    ASSERT_EQ(image.height, 50u);
    EXPECT_EQ(image.colour(0, 0), (Rgb{0, 0, 1}));
    EXPECT_EQ(image.colour(69, 40), (Rgb{69, 40, 1}));
}

TEST(Exr, SpreadsGreyOverAllColours) { EXPECT_EQ(read(exr({"Y"})).colour(2, 0), (Rgb{2, 2, 2})); }

TEST(Exr, NeedsColour) { EXPECT_THAT(error_of(exr({"U", "V"})), HasSubstr("no channel R")); }

TEST(Hdr, ReadsRunLengths) {
    const Image image = read(hdr());
    ASSERT_EQ(image.width, 8u);
    for (std::uint32_t x = 0; x < 8; ++x) EXPECT_EQ(image.colour(x, 0), (Rgb{1, 0.5f, 0.25f}));
}

TEST(Hdr, ReadsPlainPixelsAndOldRuns) {
    const Image image = read(std::string("#?RGBE\n\n-Y 1 +X 4\n") + std::string("\x80\x40\x20\x81\x01\x01\x01\x03", 8));
    ASSERT_EQ(image.width, 4u);
    EXPECT_EQ(image.colour(3, 0), (Rgb{1, 0.5f, 0.25f}));
}

TEST(Tiff, ReadsWholeNumbersAndFloatsInStripsAndTiles) {
    for (const int bits : {8, 16, 32})
        for (const auto& [tiles, apart] : {std::pair{false, false}, {true, false}, {false, true}, {true, true}}) {
            const Image image = read(test::tiff(bits, tiles, apart), {Encoding::Curve::linear, 1});
            ASSERT_EQ(image.width, 20u);
            ASSERT_EQ(image.height, 18u);
            const float one = bits == 32 ? 1 : bits == 16 ? 1 / 65535.0f : 1 / 255.0f;
            for (const std::uint32_t y : {0u, 5u, 17u})
                for (const std::uint32_t x : {0u, 15u, 16u, 19u}) {
                    EXPECT_NEAR(image.colour(x, y).r, float(x) * one, 1e-6f)
                        << bits << " bits, tiles: " << tiles << ", colour by colour: " << apart;
                    EXPECT_NEAR(image.colour(x, y).g, float(y) * one, 1e-6f);
                    EXPECT_NEAR(image.colour(x, y).b, one, 1e-6f);
                }
        }
}

TEST(Tiff, ReadsNumbersOfEverySize) {
    enum { whole = 1, with_sign, real };
    const auto greys = [](int bits, int format, const std::string& samples) {
        const Image image = read(test::grey_tiff(bits, format, samples), {Encoding::Curve::linear, 1});
        return std::pair{image.colour(0, 0).g, image.colour(1, 0).g};
    };
    const auto expect = [](std::pair<float, float> got, float first, float second) {
        EXPECT_NEAR(got.first, first, 2e-4f);
        EXPECT_NEAR(got.second, second, 2e-4f);
    };
    expect(greys(8, with_sign, test::raw(std::int8_t{127}, std::int8_t{-3})), 1, 0);
    expect(greys(16, with_sign, test::raw(std::int16_t{16384}, std::int16_t{-9})), 0.5f, 0);
    expect(greys(32, with_sign, test::raw(std::int32_t{1 << 29}, std::int32_t{-9})), 0.25f, 0);
    expect(greys(32, whole, test::raw(std::uint32_t{1} << 30, ~std::uint32_t{0})), 0.25f, 1);
    expect(greys(16, real, test::raw(std::uint16_t{0x4200}, std::uint16_t{0x3800})), 3, 0.5f);
    expect(greys(64, real, test::raw(2.5, -1.0)), 2.5f, -1);
}

TEST(Tiff, TurnsPalettesIntoColours) {
    const Image image = read(test::palette_tiff());
    ASSERT_EQ(image.width, 2u);
    EXPECT_EQ(image.colour(0, 0), (Rgb{1, 0, 0}));
    EXPECT_NEAR(image.colour(1, 0).b, 0.2159f, 1e-3f);
}

TEST(Tga, ReadsPalettesAndRunsFromAnyCorner) {
    // 4 x 1 pixels of a palette whose first colour is number 5: three of 6, one of 5; read from the right, then not
    std::string file("\0\1\11\5\0\2\0\30\0\0\0\0\4\0\1\0\10\60", 18);
    file += std::string("\0\0\377", 3) + std::string("\377\0\0", 3) + std::string("\202\6\0\5", 4);
    const Image from_right = read(file);
    ASSERT_EQ(from_right.width, 4u);
    EXPECT_EQ(from_right.colour(0, 0), (Rgb{1, 0, 0}));
    for (const std::uint32_t x : {1u, 2u, 3u}) EXPECT_EQ(from_right.colour(x, 0), (Rgb{0, 0, 1}));
    file[17] = 32;
    EXPECT_EQ(read(file).colour(3, 0), (Rgb{1, 0, 0}));
    file.back() = 7;
    EXPECT_THAT(error_of(file), HasSubstr("not in the palette"));
}

TEST(Tga, ReadsColoursAndGreyFromTheLowestRow) {
    for (const int bits : {32, 24, 16, 8})
        for (const bool packed : {false, true}) {
            const Image image = read(test::tga(bits, packed));
            ASSERT_EQ(image.width, 3u);
            ASSERT_EQ(image.height, 2u);
            EXPECT_EQ(image.colour(0, 0), (bits == 8 ? Rgb{1, 1, 1} : Rgb{1, 0, 0})) << bits;
            EXPECT_EQ(image.colour(2, 0), (bits == 8 ? Rgb{0, 0, 0} : Rgb{0, 0, 1})) << bits;
            EXPECT_EQ(image.colour(0, 1), (Rgb{1, 1, 1}));
            EXPECT_NEAR(image.colour(1, 1).g, 0.2159f, 0.02f);
            EXPECT_EQ(image.has_alpha(), bits == 32);
            if (bits == 32) {
                EXPECT_NEAR(image.alpha(2, 0), 128 / 255.0f, 1e-6f);
            }
        }
}

TEST(Tga, IsRefusedWhereItIsTooShortForItsPixels) {
    EXPECT_THAT(error_of(test::tga(24, false).substr(0, 30)), HasSubstr("TGA: the file ends early"));
    auto huge = test::tga(24, true);
    huge[13] = huge[15] = 127;
    EXPECT_THAT(error_of(huge), HasSubstr("too large"));
}

TEST(Pictures, OfUnknownKindsAreRefused) {
    EXPECT_THAT(error_of("GIT89a"), HasSubstr("not an image of a known format"));
    EXPECT_THAT(error_of(""), HasSubstr("not an image of a known format"));
}

TEST(Pictures, OfImpossibleSizesAreRefused) {
    EXPECT_THAT(error_of("#?RGBE\n\n-Y 100000 +X 100000\nabcd"), HasSubstr("too large"));
    EXPECT_THAT(error_of("#?RGBE\n\n-Y 0 +X 5\nabcd"), HasSubstr("no pixels"));
    EXPECT_THAT(error_of("#?RGBE\n\n-Y 8000 +X 8000\nabcd"), HasSubstr("too short"));
}

// Headers that promise far more than the file holds are refused before memory is taken.
TEST(Pictures, OfHostileHeadersAreRefused) {
    std::string png = small_png();
    png.replace(16, 8, std::string("\0\x0f\0\0\0\x0f\0\0", 8));  // width and height: 983,040
    const auto check = crc32(0, reinterpret_cast<const Bytef*>(png.data()) + 12, 17);
    for (int i = 0; i < 4; ++i) png[29 + std::size_t(i)] = static_cast<char>(check >> (24 - 8 * i));
    EXPECT_THAT(error_of(png), HasSubstr("too large"));
    std::string wide = exr({"R", "G", "B"});
    const std::string name("dataWindow\0box2i", 16);
    const std::size_t at = wide.find(name);
    ASSERT_NE(at, std::string::npos);
    wide.replace(at + name.size() + 1 + 4 + 8, 8, std::string("\xff\xff\xff\x0f\xff\xff\xff\x0f", 8));
    EXPECT_NE(error_of(wide), "no error");
}

class EveryPicture : public testing::TestWithParam<std::string> {};

TEST_P(EveryPicture, IsReadOrRefusedWhereverItIsCut) {
    const std::string& bytes = GetParam();
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        const std::string problem = error_of(bytes.substr(0, length));
        // what stands behind the pixels may be missing
        if (length < bytes.size() - bytes.size() / 4) {
            EXPECT_NE(problem, "no error") << length;
        }
    }
}

TEST_P(EveryPicture, NeverCrashesWithABrokenByte) {
    const std::string& bytes = GetParam();
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (const char byte : {'\0', '\x7f', '\xff'}) {
            std::string broken = bytes;
            broken[i] = byte;
            error_of(broken);
        }
}

INSTANTIATE_TEST_SUITE_P(Kind, EveryPicture,
                         testing::Values(small_png(), jpeg(100, 3), exr({"R", "G", "B"}), hdr(), test::tiff(8, false),
                                         test::tiff(16, true), test::tga(24, false), test::tga(32, true)));

INSTANTIATE_TEST_SUITE_P(RarerKind, EveryPicture,
                         testing::Values(test::bmp(8, false, true), test::bmp(32, true, true), test::netpbm('3'),
                                         test::netpbm('7'), test::pfm(true, -1), test::webp(false, true),
                                         test::webp(true, true), test::gif(true), test::cmyk_jpeg(1, 2, 3, 4, true),
                                         test::ktx({.packing = 2}, std::string(18, 'x')), test::chroma_exr(1, 1, 1),
                                         test::parts_exr()));

}  // namespace
}  // namespace lightnet::image_file_test
