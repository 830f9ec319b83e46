#include "core/readers/images/image_facts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace lightnet {
namespace {

constexpr float greatest_half = 65504;

/// Does it hold for any pixel?
bool any_pixel(const Image& image, const auto& holds) {
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x)
            if (holds(x, y)) return true;
    return false;
}

float sound_number(float c) { return std::isfinite(c) ? c : c > 0 ? greatest_half : 0; }

}  // namespace

bool is_coloured(const Image& image) {
    return any_pixel(image, [&](std::uint32_t x, std::uint32_t y) {
        const Rgb c = image.colour(x, y);
        return c.r != c.g || c.g != c.b;
    });
}

bool is_translucent(const Image& image) {
    return image.has_alpha() &&
           any_pixel(image, [&](std::uint32_t x, std::uint32_t y) { return image.alpha(x, y) != 1; });
}

SoundImage sound(Image image) {
    const auto strange = [&](std::uint32_t x, std::uint32_t y) {
        return !finite(image.colour(x, y)) || !std::isfinite(image.alpha(x, y));
    };
    if (image.coded() || !any_pixel(image, strange)) return {std::move(image)};
    std::vector<Rgb> pixels;
    std::vector<float> alpha;
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const Rgb c = image.colour(x, y);
            count += strange(x, y) ? 1 : 0;
            pixels.push_back({sound_number(c.r), sound_number(c.g), sound_number(c.b)});
            if (image.has_alpha()) alpha.push_back(sound_number(image.alpha(x, y)));
        }
    return {{image.width, image.height, pixels, alpha},
            fmt::format("{} of its pixels are infinite or no numbers: 65504 and 0 are taken", count)};
}

}  // namespace lightnet
