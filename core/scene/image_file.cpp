#include "core/scene/image_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/error.hpp"
#include "core/scene/image_decoders.hpp"

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

/// The curve at all values that a sample can have: pictures are large, pow() is slow.
std::vector<float> curve(const Encoding& encoding, std::size_t steps) {
    std::vector<float> table(steps);
    for (std::size_t i = 0; i < steps; ++i) table[i] = linear(float(i) / float(steps - 1), encoding);
    return table;
}

Image to_linear(const decoders::Raster& raster, const Encoding& encoding) {
    const auto table = curve(encoding, raster.wide ? 65536 : 256);
    const float highest = float(table.size() - 1);
    const std::size_t count = std::size_t{raster.width} * raster.height;
    Image image{raster.width, raster.height, std::vector<Rgb>(count), {}};
    if (raster.channels == 4) image.alpha.resize(count);
    const std::uint8_t* at = raster.bytes.data();
    const auto sample = [&] {
        const unsigned value = raster.wide ? at[0] * 256u + at[1] : at[0];
        at += raster.wide ? 2 : 1;
        return value;
    };
    for (std::size_t i = 0; i < count; ++i) {
        Rgb& pixel = image.pixels[i];
        pixel.r = table[sample()];
        pixel.g = table[sample()];
        pixel.b = table[sample()];
        if (raster.channels == 4) image.alpha[i] = float(sample()) / highest;  // never encoded
    }
    return image;
}

bool begins(std::span<const std::byte> bytes, std::string_view start) {
    return bytes.size() >= start.size() && std::memcmp(bytes.data(), start.data(), start.size()) == 0;
}

}  // namespace

void decoders::check_size(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t most_pixels = std::int64_t{1} << 26, longest_side = 1 << 20;
    if (width <= 0 || height <= 0) throw Error("the picture has no pixels");
    if (width > longest_side || height > longest_side || width * height > most_pixels)
        throw Error(fmt::format("a picture of {} x {} pixels is too large (at most 2^26 pixels)", width, height));
}

Image read_image(std::span<const std::byte> bytes, const Encoding& encoding) {
    if (begins(bytes, "\xFF\xD8\xFF")) return to_linear(decoders::read_jpeg(bytes), encoding);
    if (begins(bytes, "\x89PNG\r\n\x1A\n")) return to_linear(decoders::read_png(bytes), encoding);
    if (begins(bytes, "\x76\x2F\x31\x01")) return decoders::read_exr(bytes);
    if (begins(bytes, "#?")) return decoders::read_hdr(bytes);
    throw Error("not a picture of a known kind (JPEG, PNG, OpenEXR, Radiance HDR)");
}

}  // namespace lightnet
