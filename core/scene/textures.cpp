#include "core/scene/textures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lightnet {
namespace {

// A row or column of an image; -1: outside of it.
std::int64_t wrapped(std::int64_t i, std::int64_t size, Wrap wrap) {
    if (i >= 0 && i < size) return i;
    switch (wrap) {
        case Wrap::repeat:
            return (i % size + size) % size;
        case Wrap::clamp:
            return std::clamp<std::int64_t>(i, 0, size - 1);
        case Wrap::black:
            break;
    }
    return -1;
}

Rgb pixel(const Image& image, std::int64_t x, std::int64_t y, Wrap wrap) {
    x = wrapped(x, image.width, wrap);
    y = wrapped(y, image.height, wrap);
    return x < 0 || y < 0 ? Rgb{} : image.pixels[std::size_t(y) * image.width + std::size_t(x)];
}

Rgb bilinear(const Image& image, float x, float y, Wrap wrap) {
    const float left = std::floor(x), top = std::floor(y);
    const float dx = x - left, dy = y - top;
    const auto i = static_cast<std::int64_t>(left), j = static_cast<std::int64_t>(top);
    return (pixel(image, i, j, wrap) * (1 - dx) + pixel(image, i + 1, j, wrap) * dx) * (1 - dy) +
           (pixel(image, i, j + 1, wrap) * (1 - dx) + pixel(image, i + 1, j + 1, wrap) * dx) * dy;
}

}  // namespace

Rgb look_up(const Texture& texture, Vec2 uv) {
    Rgb value = texture.scale;
    if (texture.image && !texture.image->pixels.empty()) {
        const Image& image = *texture.image;
        // Far outside, floats can't tell pixels apart; staying within ±2²⁰ repeats keeps the integers small.
        const auto tame = [](float t) { return std::isfinite(t) ? std::clamp(t, -0x1p20f, 0x1p20f) : 0.0f; };
        const float s = tame(uv.x * texture.uv_scale.x + texture.uv_offset.x);
        const float t = tame(uv.y * texture.uv_scale.y + texture.uv_offset.y);
        value =
            value * bilinear(image, s * float(image.width) - 0.5f, (1 - t) * float(image.height) - 0.5f, texture.wrap);
    }
    if (texture.invert) value = Rgb{1, 1, 1} - value;
    return {std::max(0.0f, value.r), std::max(0.0f, value.g), std::max(0.0f, value.b)};
}

}  // namespace lightnet
