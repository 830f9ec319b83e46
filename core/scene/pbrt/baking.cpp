#include "core/scene/pbrt/baking.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/scene/pbrt/textures.hpp"

namespace lightnet::pbrt {
namespace {

Texture painted(std::uint32_t width, std::uint32_t height, const std::function<Rgb(Vec2)>& value) {
    Image image{width, height, {}, {}};
    image.pixels.reserve(std::size_t{width} * height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            image.pixels.push_back(value({(float(x) + 0.5f) / float(width), 1 - (float(y) + 0.5f) / float(height)}));
    Texture texture;
    texture.image = std::make_shared<const Image>(std::move(image));
    return texture;
}

bool laid_alike(const Texture& a, const Texture& b) {
    return a.wrap == b.wrap && a.uv_scale == b.uv_scale && a.uv_offset == b.uv_offset;
}

}  // namespace

Texture paint(std::uint32_t size, const std::function<Rgb(Vec2)>& value) { return painted(size, size, value); }

Baked bake(const std::vector<Texture>& inputs, const std::function<Rgb(std::span<const Rgb>)>& combine) {
    std::vector<Rgb> values(inputs.size());
    const Texture* first = nullptr;
    bool alike = true;
    std::uint32_t width = 1, height = 1;
    for (const auto& texture : inputs) {
        if (!texture.image) continue;
        width = std::max(width, texture.image->width);
        height = std::max(height, texture.image->height);
        if (first)
            alike = alike && laid_alike(*first, texture);
        else
            first = &texture;
    }
    const auto all = [&](Vec2 uv, bool laid) {
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            Texture input = inputs[i];
            if (laid) input.uv_scale = {1, 1}, input.uv_offset = {0, 0};
            values[i] = look_up(input, uv);
        }
        return combine(values);
    };
    if (!first) {
        Texture constant;
        constant.scale = all({0, 0}, true);
        return {constant, true};
    }
    if (!alike) {
        constexpr std::uint32_t size = 1024;
        return {paint(size, [&](Vec2 uv) { return all(uv, false); }), false};
    }
    Texture result = painted(width, height, [&](Vec2 uv) { return all(uv, true); });
    result.wrap = first->wrap;
    result.uv_scale = first->uv_scale;
    result.uv_offset = first->uv_offset;
    return {result, true};
}

}  // namespace lightnet::pbrt
