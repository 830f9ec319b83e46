#include "core/film/png.hpp"

#include <png.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"

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

}  // namespace

std::array<float, 255> least_of_levels() {
    std::array<float, 255> least{};
    for (int level = 1; level <= 255; ++level) least[static_cast<std::size_t>(level) - 1] = least_of_level(level);
    return least;
}

std::string png_of(const Picture& picture) {
    std::vector<std::uint8_t> values;
    values.reserve(picture.beauty.size() * 3);
    for (const Rgb& pixel : picture.beauty)
        for (const float channel : {pixel.r, pixel.g, pixel.b}) values.push_back(srgb(channel));

    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture.width;
    image.height = picture.height;
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, values.data(), 0, nullptr))
        throw Error("png", image.message);
    bytes.resize(size);
    return bytes;
}

void write_png(const std::filesystem::path& path, const Picture& picture) { write_file(path, png_of(picture)); }

}  // namespace lightnet
