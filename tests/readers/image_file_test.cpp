#include "core/readers/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>  // jpeglib.h needs it

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <jpeglib.h>
#include <png.h>
#include <zlib.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "tests/support/memory_files.hpp"

namespace lightnet {
namespace {

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

/// Two pixels beside each other.
std::string png(png_uint_32 format, const void* samples, std::uint32_t width = 2) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width, image.height = 1, image.format = format;
    png_alloc_size_t size = 0;
    png_image_write_to_memory(&image, nullptr, &size, 0, samples, 0, nullptr);
    std::string bytes(size, '\0');
    png_image_write_to_memory(&image, bytes.data(), &size, 0, samples, 0, nullptr);
    bytes.resize(size);
    return bytes;
}

std::string small_png() {
    const std::uint8_t samples[] = {255, 0, 188, 0, 255, 128};
    return png(PNG_FORMAT_RGB, samples);
}

std::string jpeg(std::uint8_t value, int channels) {
    jpeg_compress_struct c;
    jpeg_error_mgr errors;
    c.err = jpeg_std_error(&errors);
    jpeg_create_compress(&c);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&c, &memory, &size);
    c.image_width = 16, c.image_height = 8, c.input_components = channels;
    c.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&c);
    jpeg_set_quality(&c, 100, TRUE);
    jpeg_start_compress(&c, TRUE);
    std::vector<std::uint8_t> row(16u * static_cast<unsigned>(channels), value);
    JSAMPROW pointer = row.data();
    while (c.next_scanline < c.image_height) jpeg_write_scanlines(&c, &pointer, 1);
    jpeg_finish_compress(&c);
    jpeg_destroy_compress(&c);
    std::string bytes(reinterpret_cast<char*>(memory), size);
    std::free(memory);
    return bytes;
}

class Memory final : public Imf::OStream {
public:
    Memory() : Imf::OStream("test") {}
    void write(const char bytes[], int count) override {
        if (bytes_.size() < at_ + static_cast<std::size_t>(count)) bytes_.resize(at_ + static_cast<std::size_t>(count));
        std::memcpy(bytes_.data() + at_, bytes, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

std::string exr(const std::vector<std::string>& channels) {
    Memory memory;
    {
        Imf::Header header(3, 2);
        Imf::FrameBuffer buffer;
        static std::vector<std::vector<float>> planes;
        planes.assign(channels.size(), {0.25f, 1, 2, 3, 4, 1000});
        for (std::size_t i = 0; i < channels.size(); ++i) {
            header.channels().insert(channels[i], Imf::Channel(Imf::FLOAT));
            for (float& value : planes[i]) value += float(i);
            buffer.insert(channels[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(planes[i].data()), sizeof(float),
                                                  3 * sizeof(float)));
        }
        Imf::OutputFile file(memory, header);
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    }
    return memory.bytes();
}

/// Eight pixels of {1, 0.5, 0.25} with run lengths.
std::string hdr() {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
    text += std::string("\x02\x02\x00\x08", 4);
    for (const unsigned char value : {128, 64, 32, 129}) {
        text += static_cast<char>(128 + 8);
        text += static_cast<char>(value);
    }
    return text;
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

TEST(Exr, SpreadsGreyOverAllColours) { EXPECT_EQ(read(exr({"Y"})).colour(2, 0), (Rgb{2, 2, 2})); }

TEST(Exr, NeedsColour) { EXPECT_THAT(error_of(exr({"Z"})), HasSubstr("no channel R")); }

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

TEST(Pictures, OfUnknownKindsAreRefused) {
    EXPECT_THAT(error_of("GIF89a"), HasSubstr("not a picture of a known kind"));
    EXPECT_THAT(error_of(""), HasSubstr("not a picture of a known kind"));
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

INSTANTIATE_TEST_SUITE_P(Kind, EveryPicture, testing::Values(small_png(), jpeg(100, 3), exr({"R", "G", "B"}), hdr()));

}  // namespace
}  // namespace lightnet
