#include "core/scene/pbrt/baking.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/scene/pbrt/textures.hpp"

namespace lightnet::pbrt {
namespace {

const ImageTexture* picture_of(const Texture& texture) { return std::get_if<ImageTexture>(&texture.pattern); }

Texture painted(std::uint32_t width, std::uint32_t height, const std::function<Rgb(Vec2)>& value) {
    std::vector<Rgb> pixels;
    pixels.reserve(std::size_t{width} * height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            pixels.push_back(value({(float(x) + 0.5f) / float(width), 1 - (float(y) + 0.5f) / float(height)}));
    ImageTexture picture;
    picture.image = std::make_shared<const Image>(width, height, pixels);
    Texture texture;
    texture.pattern = std::move(picture);
    return texture;
}

bool laid_alike(const ImageTexture& a, const ImageTexture& b) {
    return a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.uv == b.uv;
}

}  // namespace

Texture paint(std::uint32_t size, const std::function<Rgb(Vec2)>& value) { return painted(size, size, value); }

Baked bake(const std::vector<Texture>& inputs, const std::function<Rgb(std::span<const Rgb>)>& combine) {
    std::vector<Rgb> values(inputs.size());
    const ImageTexture* first = nullptr;
    bool alike = true;
    std::uint32_t width = 1, height = 1;
    for (const auto& texture : inputs) {
        const ImageTexture* picture = picture_of(texture);
        if (!picture) continue;
        width = std::max(width, picture->image->width);
        height = std::max(height, picture->image->height);
        if (first)
            alike = alike && laid_alike(*first, *picture);
        else
            first = picture;
    }
    const auto all = [&](Vec2 uv, bool laid) {
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            Texture input = inputs[i];
            if (auto* picture = std::get_if<ImageTexture>(&input.pattern); picture && laid) picture->uv = {};
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
    auto& picture = std::get<ImageTexture>(result.pattern);
    picture.wrap_u = first->wrap_u;
    picture.wrap_v = first->wrap_v;
    picture.uv = first->uv;
    return {result, true};
}

}  // namespace lightnet::pbrt
