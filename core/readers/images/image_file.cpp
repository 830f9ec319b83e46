#include "core/readers/images/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/images/image_decoders.hpp"

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

constexpr const char* known_kinds = "JPEG, PNG, TIFF, TGA, BMP, GIF, WebP, PNM, PFM, KTX 2, OpenEXR, Radiance HDR";

bool begins(std::span<const std::byte> bytes, std::string_view start, std::size_t at = 0) {
    if (bytes.size() < at + start.size()) return false;
    return start.empty() || std::memcmp(bytes.data() + at, start.data(), start.size()) == 0;  // no pointer to nothing
}

/// How files of a kind begin, and what reads them; nothing does so: what they are called.
struct Kind {
    std::string_view start;
    decoders::Found (*read)(decoders::Input) = nullptr;
    const char* name = nullptr;
    std::string_view further{};  // what stands at byte 8, or 4 of those without a start
};

template <auto decode>
decoders::Found found(decoders::Input bytes) {
    return decode(bytes);
}

constexpr std::array kinds{
    Kind{"\xFF\xD8\xFF", found<decoders::read_jpeg>},
    Kind{"\x89PNG\r\n\x1A\n", found<decoders::read_png>},
    Kind{"\x76\x2F\x31\x01", found<decoders::read_exr>},
    Kind{"#?", found<decoders::read_hdr>},
    Kind{{"II*\0", 4}, found<decoders::read_tiff>},
    Kind{{"MM\0*", 4}, found<decoders::read_tiff>},
    Kind{{"II+\0", 4}, found<decoders::read_tiff>},
    Kind{"GIF87a", found<decoders::read_gif>},
    Kind{"GIF89a", found<decoders::read_gif>},
    Kind{"RIFF", found<decoders::read_webp>, nullptr, "WEBP"},
    Kind{"\xABKTX 20\xBB\r\n\x1A\n", found<decoders::read_ktx>},
    Kind{"\xABKTX 11\xBB\r\n\x1A\n", nullptr, "KTX 1"},
    Kind{"DDS ", nullptr, "DDS"},
    Kind{"8BPS", nullptr, "Photoshop's PSD"},
    Kind{{"\0\0\0\x0CjP  ", 8}, nullptr, "JPEG 2000"},
    Kind{"\xFF\x4F\xFF\x51", nullptr, "JPEG 2000"},
    Kind{{"\0\0\0\x0CJXL ", 8}, nullptr, "JPEG XL"},
    Kind{"\xFF\x0A", nullptr, "JPEG XL"},
    Kind{"", nullptr, "AVIF", "ftypavif"},
    Kind{"", nullptr, "HEIC", "ftyphei"},
    Kind{"", nullptr, "HEIC", "ftypmif1"},
};

bool is_of(std::span<const std::byte> bytes, const Kind& kind) {
    return begins(bytes, kind.start) && begins(bytes, kind.further, kind.start.empty() ? 4 : 8);
}

/// "P6" and the like: letters that a blank ends, and nothing else tells.
bool is_netpbm(std::span<const std::byte> bytes, std::string_view letters) {
    if (bytes.size() < 3 || bytes[0] != std::byte{'P'}) return false;
    const auto at = [&](std::size_t i) { return static_cast<char>(bytes[i]); };
    return letters.find(at(1)) != letters.npos && std::string_view(" \t\r\n#").find(at(2)) != std::string_view::npos;
}

/// A header that has a known size.
bool is_bmp(std::span<const std::byte> bytes) {
    constexpr std::array<unsigned, 9> sizes{12, 16, 40, 52, 56, 64, 108, 124, 20};
    if (bytes.size() < 18 || !begins(bytes, "BM")) return false;
    const unsigned size = std::to_integer<unsigned>(bytes[14]);
    return bytes[15] == std::byte{} && std::ranges::find(sizes, size) != sizes.end();
}

using Reading = decoders::Found (*)(decoders::Input);

/// What reads a file that begins so. Throws Error: nothing does.
Reading reading_of(std::span<const std::byte> beginning) {
    for (const Kind& kind : kinds) {
        if (!is_of(beginning, kind)) continue;
        if (kind.read) return kind.read;
        throw Error(std::string("images of the format ") + kind.name + " are not supported (" + known_kinds + " are)");
    }
    if (is_netpbm(beginning, "1234567")) return found<decoders::read_netpbm>;
    if (is_netpbm(beginning, "Ff")) return found<decoders::read_pfm>;
    if (is_bmp(beginning)) return found<decoders::read_bmp>;
    if (decoders::is_tga(beginning)) return found<decoders::read_tga>;
    throw Error(std::string("not an image of a known format (") + known_kinds + ")");
}

}  // namespace

void decoders::check_size(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t most_pixels = std::int64_t{1} << 26, longest_side = 1 << 20;
    if (width <= 0 || height <= 0) throw Error("the image has no pixels");
    if (width > longest_side || height > longest_side || width * height > most_pixels)
        throw Error(fmt::format("an image of {} x {} pixels is too large (at most 2^26 pixels)", width, height));
}

void expect_image(std::span<const std::byte> beginning) { reading_of(beginning); }

void decoders::check_size(std::int64_t width, std::int64_t height, Input file, std::int64_t pixels_per_byte) {
    check_size(width, height);
    if (width * height / pixels_per_byte > static_cast<std::int64_t>(file.size()))
        throw Error(fmt::format("the file ends early: {} bytes can't be {} x {} pixels", file.size(), width, height));
}

Image read_image(std::span<const std::byte> bytes, const Encoding& encoding) try {
    auto found = reading_of(bytes)(bytes);
    if (auto* raster = std::get_if<decoders::Raster>(&found)) return to_image(std::move(*raster), encoding);
    return std::get<Image>(std::move(found));
} catch (const std::bad_alloc&) {
    throw MissingHere("there is not enough memory for its pixels");
}

Image mid_grey() { return {1, 1, {{0.5f, 0.5f, 0.5f}}}; }

}  // namespace lightnet
