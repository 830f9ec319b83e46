#include "core/film/png.hpp"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/film/ocio.hpp"

namespace lightnet {
namespace {

// IEC 61966-2-1.
std::uint8_t srgb(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    const float curve = linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(std::lround(curve * 255));
}

// Halves the numbers between 0 and 1 as the integers that they are stored as, which have the same order.
float least_of_level(int level) {
    std::uint32_t below = 0, there = std::bit_cast<std::uint32_t>(1.0f);
    while (there - below > 1) {
        const auto middle = below + (there - below) / 2;
        (srgb(std::bit_cast<float>(middle)) >= level ? there : below) = middle;
    }
    return std::bit_cast<float>(there);
}

/// srgb() by looking: a channel is of the level whose least it has reached. A power for each takes longer than all
/// else.
class Levels {
public:
    Levels() {
        for (int level = 1; level <= 255; ++level) least_[level] = least_of_level(level);
        least_.back() = std::numeric_limits<float>::infinity();
        for (int i = 0, level = 0; i <= parts; ++i) {
            while (float(i) / parts >= least_[level + 1]) ++level;
            first_[i] = static_cast<std::uint8_t>(level);
        }
    }
    std::uint8_t of(float linear) const {
        if (!(linear > 0)) return 0;
        if (linear >= 1) return 255;
        std::size_t level = first_[static_cast<std::size_t>(linear * parts)];
        while (linear >= least_[level + 1]) ++level;
        return static_cast<std::uint8_t>(level);
    }

private:
    static constexpr int parts = 4096;             // of 0 … 1
    std::array<float, 257> least_{};               // by level
    std::array<std::uint8_t, parts + 1> first_{};  // the level where a part begins
};

const Levels& levels() {
    static const Levels all;
    return all;
}

// In words.
std::string curve_of(const PngView& view) {
    switch (view.tone) {
        case Tone::filmic:
            return "filmic curve";
        case Tone::aces:
            return "ACES curve";
        case Tone::agx:
            return "AgX curve";
        case Tone::ocio:
            return "OpenColorIO's view " + view.ocio;
        default:
            return "clipped to 0..1";
    }
}

std::uint8_t quantized(float encoded) {
    return encoded > 0 ? static_cast<std::uint8_t>(std::lround(std::min(encoded, 1.0f) * 255)) : std::uint8_t{0};
}

// What the pixels show before they are toned.
std::vector<Rgb> exposed(const Picture& picture, float exposure, bool with_alpha) {
    std::vector<Rgb> pixels = picture.beauty;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] *= exposure;
        if (with_alpha && picture.alpha[i] > 0) pixels[i] = pixels[i] / picture.alpha[i];
    }
    return pixels;
}

void append_number(std::string& to, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(value >> shift & 0xff);
}

void append_chunk(std::string& png, std::string_view type, std::string_view data) {
    append_number(png, static_cast<std::uint32_t>(data.size()));
    const std::size_t begins = png.size();
    png.append(type).append(data);
    const auto* bytes = reinterpret_cast<const Bytef*>(png.data() + begins);
    append_number(png, static_cast<std::uint32_t>(::crc32_z(0, bytes, png.size() - begins)));
}

/// 8 bits of each channel, row by row.
struct Bitmap {
    std::vector<std::uint8_t> values;
    std::uint32_t width = 0, height = 0;
    bool alpha = false;

    std::size_t row_bytes() const { return std::size_t{width} * (alpha ? 4 : 3); }
};

// Packing takes longer than all else; what is stored as it is, is there at once.
std::string stored(const Bitmap& bitmap) {
    std::string rows;
    rows.reserve(bitmap.values.size() + bitmap.height);
    for (std::uint32_t y = 0; y < bitmap.height; ++y) {
        rows += '\0';  // no filter
        rows.append(reinterpret_cast<const char*>(&bitmap.values[y * bitmap.row_bytes()]), bitmap.row_bytes());
    }
    uLongf size = ::compressBound(rows.size());
    std::string data(size, '\0');
    if (::compress2(reinterpret_cast<Bytef*>(data.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                    rows.size(), Z_NO_COMPRESSION) != Z_OK)
        throw Error("png", "there is not enough memory to store it");
    data.resize(size);
    std::string head;
    append_number(head, bitmap.width);
    append_number(head, bitmap.height);
    for (const int value : {8, bitmap.alpha ? 6 : 2, 0, 0, 0}) head += static_cast<char>(value);
    std::string png("\x89PNG\r\n\x1a\n");
    append_chunk(png, "IHDR", head);
    append_chunk(png, "sRGB", std::string(1, '\0'));  // perceptual
    append_chunk(png, "IDAT", data);
    append_chunk(png, "IEND", {});
    return png;
}

std::string packed(const Bitmap& bitmap, png_uint_32 flags) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.flags = flags;
    image.width = bitmap.width;
    image.height = bitmap.height;
    image.format = bitmap.alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, bitmap.values.data(), 0, nullptr))
        throw Error("png", image.message);
    bytes.resize(size);
    return bytes;
}

}  // namespace

std::string tone_of(const PngView& view) {
    const auto exposure = view.stops == 0 ? std::string("1") : fmt::format("2^{:.1f}", view.stops);
    const auto curve = view.tone == Tone::ocio ? ", 8 bits" : ", sRGB transfer curve, 8 bits";
    return "exposure " + exposure + ", " + curve_of(view) + curve + (view.alpha ? ", alpha" : "");
}

std::array<float, 255> least_of_levels() {
    std::array<float, 255> least{};
    for (int level = 1; level <= 255; ++level) least[static_cast<std::size_t>(level) - 1] = least_of_level(level);
    return least;
}

std::string png_of(const Picture& picture, const PngView& view, PngEffort effort) {
    const auto exposure = static_cast<float>(std::exp2(view.stops));
    const bool with_alpha = view.alpha && !picture.alpha.empty();
    std::vector<Rgb> pixels = exposed(picture, exposure, with_alpha);
    if (view.tone == Tone::ocio) ocio::show(pixels, view.ocio);
    const Levels& by_level = levels();
    Bitmap bitmap{{}, picture.width, picture.height, with_alpha};
    auto& values = bitmap.values;
    values.reserve(pixels.size() * (with_alpha ? 4 : 3));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const bool encoded = view.tone == Tone::ocio;
        const Rgb shown = encoded ? pixels[i] : toned(pixels[i], view.tone);
        for (const float channel : {shown.r, shown.g, shown.b})
            values.push_back(encoded ? quantized(channel) : by_level.of(channel));
        if (with_alpha) values.push_back(quantized(picture.alpha[i]));
    }
    if (effort == PngEffort::small) return packed(bitmap, 0);
    constexpr std::size_t most_of_a_chunk = std::size_t{1} << 30;
    return values.size() < most_of_a_chunk ? stored(bitmap) : packed(bitmap, PNG_IMAGE_FLAG_FAST);
}

void write_png(const std::filesystem::path& path, const Picture& picture, const PngView& view) {
    write_file(path, png_of(picture, view));
}

}  // namespace lightnet
