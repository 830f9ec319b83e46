#include "core/readers/image_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>

#include "core/base/error.hpp"
#include "core/readers/image_decoders.hpp"

namespace lightnet {
namespace {

float linear(float value, const Encoding& encoding) {
    switch (encoding.curve) {
        case Encoding::Curve::linear:
            return value;
        case Encoding::Curve::gamma:
            return std::pow(value, encoding.gamma);
        default:
            return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
    }
}

/// The curve at all values that a sample can have: images are large, pow() is slow.
std::vector<float> curve(const Encoding& encoding, std::size_t steps) {
    std::vector<float> table(steps);
    for (std::size_t i = 0; i < steps; ++i) table[i] = linear(float(i) / float(steps - 1), encoding);
    return table;
}

Image::Curve shared_curve(const Encoding& encoding, bool wide) {
    return std::make_shared<const std::vector<float>>(curve(encoding, wide ? 65536 : 256));
}

Image to_image(decoders::Raster raster, const Encoding& encoding) {
    Image::Coded coded;
    coded.channels = static_cast<std::uint32_t>(raster.channels);
    coded.curve = shared_curve(encoding, raster.wide);
    if (raster.channels % 2 == 0) coded.alpha_curve = shared_curve({Encoding::Curve::linear, 1}, raster.wide);
    if (raster.wide) {
        std::vector<std::uint16_t> words(raster.bytes.size() / 2);
        for (std::size_t i = 0; i < words.size(); ++i)
            words[i] = static_cast<std::uint16_t>(raster.bytes[2 * i] * 256u + raster.bytes[2 * i + 1]);
        coded.numbers = std::move(words);
    } else {
        coded.numbers = std::move(raster.bytes);
    }
    return {raster.width, raster.height, std::move(coded)};
}

constexpr const char* no_image = "not an image of a known format (JPEG, PNG, TIFF, TGA, OpenEXR, Radiance HDR)";

bool begins(std::span<const std::byte> bytes, std::string_view start) {
    return bytes.size() >= start.size() && std::memcmp(bytes.data(), start.data(), start.size()) == 0;
}

}  // namespace

void decoders::check_size(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t most_pixels = std::int64_t{1} << 26, longest_side = 1 << 20;
    if (width <= 0 || height <= 0) throw Error("the image has no pixels");
    if (width > longest_side || height > longest_side || width * height > most_pixels)
        throw Error(fmt::format("an image of {} x {} pixels is too large (at most 2^26 pixels)", width, height));
}

void expect_image(std::span<const std::byte> bytes) {
    for (const std::string_view start :
         {std::string_view("\xFF\xD8\xFF"), std::string_view("\x89PNG\r\n\x1A\n"), std::string_view("\x76\x2F\x31\x01"),
          std::string_view("#?"), std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
          std::string_view("II+\0", 4)})
        if (begins(bytes, start)) return;
    if (!decoders::is_tga(bytes)) throw Error(no_image);
}

void decoders::check_size(std::int64_t width, std::int64_t height, Input file, std::int64_t pixels_per_byte) {
    check_size(width, height);
    if (width * height / pixels_per_byte > static_cast<std::int64_t>(file.size()))
        throw Error(fmt::format("the file ends early: {} bytes can't be {} x {} pixels", file.size(), width, height));
}

Image read_image(std::span<const std::byte> bytes, const Encoding& encoding) try {
    if (begins(bytes, "\xFF\xD8\xFF")) return to_image(decoders::read_jpeg(bytes), encoding);
    if (begins(bytes, "\x89PNG\r\n\x1A\n")) return to_image(decoders::read_png(bytes), encoding);
    if (begins(bytes, "\x76\x2F\x31\x01")) return decoders::read_exr(bytes);
    if (begins(bytes, "#?")) return decoders::read_hdr(bytes);
    if (begins(bytes, {"II*\0", 4}) || begins(bytes, {"MM\0*", 4}) || begins(bytes, {"II+\0", 4})) {
        auto found = decoders::read_tiff(bytes);
        if (auto* raster = std::get_if<decoders::Raster>(&found)) return to_image(std::move(*raster), encoding);
        return std::get<Image>(std::move(found));
    }
    if (decoders::is_tga(bytes)) return to_image(decoders::read_tga(bytes), encoding);
    throw Error(no_image);
} catch (const std::bad_alloc&) {
    throw Error("there is not enough memory for its pixels");
}

}  // namespace lightnet
