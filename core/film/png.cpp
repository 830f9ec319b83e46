#include "core/film/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
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
    std::vector<std::uint8_t> values;
    values.reserve(pixels.size() * (with_alpha ? 4 : 3));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const bool encoded = view.tone == Tone::ocio;
        const Rgb shown = encoded ? pixels[i] : toned(pixels[i], view.tone);
        for (const float channel : {shown.r, shown.g, shown.b})
            values.push_back(encoded ? quantized(channel) : srgb(channel));
        if (with_alpha) values.push_back(quantized(picture.alpha[i]));
    }

    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (effort == PngEffort::quick) image.flags |= PNG_IMAGE_FLAG_FAST;
    image.width = picture.width;
    image.height = picture.height;
    image.format = with_alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, values.data(), 0, nullptr))
        throw Error("png", image.message);
    bytes.resize(size);
    return bytes;
}

void write_png(const std::filesystem::path& path, const Picture& picture, const PngView& view) {
    write_file(path, png_of(picture, view));
}

}  // namespace lightnet
