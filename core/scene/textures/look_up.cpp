#include "core/scene/textures/look_up.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/base/error.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/textures/noise.hpp"

namespace lightnet {
namespace {

// A row or column of an image; -1: outside of it.
std::int64_t wrapped(std::int64_t i, std::int64_t size, Wrap wrap) {
    if (i >= 0 && i < size) return i;
    const auto into = [](std::int64_t a, std::int64_t period) { return (a % period + period) % period; };
    switch (wrap) {
        case Wrap::repeat:
            return into(i, size);
        case Wrap::mirror: {
            const std::int64_t there_and_back = into(i, 2 * size);
            return std::min(there_and_back, 2 * size - 1 - there_and_back);
        }
        case Wrap::clamp:
            return std::clamp<std::int64_t>(i, 0, size - 1);
        case Wrap::black:
            break;
    }
    return -1;
}

Rgb channel_of(const Image& image, std::uint32_t x, std::uint32_t y, ImageTexture::Channel channel) {
    using Channel = ImageTexture::Channel;
    const auto grey = [](float value) { return Rgb{value, value, value}; };
    if (channel == Channel::alpha) return grey(image.alpha(x, y));
    const Rgb colour = image.colour(x, y);
    switch (channel) {
        case Channel::mean:
            return grey((colour.r + colour.g + colour.b) / 3);
        case Channel::luminance:
            return grey(luminance(colour));
        case Channel::red:
            return grey(colour.r);
        case Channel::green:
            return grey(colour.g);
        case Channel::blue:
            return grey(colour.b);
        default:
            return colour;
    }
}

Rgb pixel(const ImageTexture& texture, std::int64_t x, std::int64_t y) {
    x = wrapped(x, texture.image->width, texture.wrap_u);
    y = wrapped(y, texture.image->height, texture.wrap_v);
    if (x < 0 || y < 0) return {};
    return channel_of(*texture.image, std::uint32_t(x), std::uint32_t(y), texture.channel);
}

Rgb bilinear(const ImageTexture& texture, float x, float y) {
    const float left = std::floor(x), top = std::floor(y);
    const float dx = x - left, dy = y - top;
    const auto i = static_cast<std::int64_t>(left), j = static_cast<std::int64_t>(top);
    if (texture.channel == ImageTexture::Channel::colour) {
        const Image& image = *texture.image;
        const auto x0 = wrapped(i, image.width, texture.wrap_u), x1 = wrapped(i + 1, image.width, texture.wrap_u);
        const auto y0 = wrapped(j, image.height, texture.wrap_v), y1 = wrapped(j + 1, image.height, texture.wrap_v);
        if (x0 >= 0 && x1 >= 0 && y0 >= 0 && y1 >= 0)
            return image.square(std::uint32_t(x0), std::uint32_t(x1), std::uint32_t(y0), std::uint32_t(y1))
                .bilinear(dx, dy);
    }
    return (pixel(texture, i, j) * (1 - dx) + pixel(texture, i + 1, j) * dx) * (1 - dy) +
           (pixel(texture, i, j + 1) * (1 - dx) + pixel(texture, i + 1, j + 1) * dx) * dy;
}

// Far outside, floats can't tell pixels apart; staying within ±2²⁰ repeats keeps the integers small.
float tame(float t) { return std::isfinite(t) ? std::clamp(t, -0x1p20f, 0x1p20f) : 0.0f; }

Vec2 laid(const UvTransform& by, Vec2 uv) {
    uv = {uv.x * by.scale.x, uv.y * by.scale.y};
    if (by.turn != 0) {
        const float c = std::cos(by.turn), s = std::sin(by.turn);
        uv = {c * uv.x - s * uv.y, s * uv.x + c * uv.y};
    }
    return {tame(uv.x + by.offset.x), tame(uv.y + by.offset.y)};
}

Vec2 projected(const ProjectedTexture& by, Vec3 position) {
    const Vec3 p = transform_point(by.from_world, position);
    using By = ProjectedTexture::By;
    if (by.by == By::plane) return {p.x, p.y};
    const float turn = std::atan2(p.y, p.x);
    if (by.by == By::cylinder) return {(pi + turn) / (2 * pi), p.z};
    const float from_axis = std::atan2(std::sqrt(p.x * p.x + p.y * p.y), p.z);
    return {from_axis / pi, (turn < 0 ? turn + 2 * pi : turn) / (2 * pi)};
}

Rgb grey(float value) { return {value, value, value}; }

/// The value of a pattern; one function for each.
struct Pattern {
    std::span<const Texture> textures;
    const TexturePlace& place;

    Rgb of(TextureId texture) const { return value_at(textures, texture, place); }
    Rgb operator()(std::monostate) const { return {1, 1, 1}; }
    Rgb operator()(const ImageTexture& t) const {
        if (!t.image || t.image->empty()) return {1, 1, 1};
        const Vec2 at = laid(t.uv, place.uv);
        const float x = at.x * float(t.image->width), y = (1 - at.y) * float(t.image->height);
        if (t.nearest) return pixel(t, std::int64_t(std::floor(x)), std::int64_t(std::floor(y)));
        return bilinear(t, x - 0.5f, y - 0.5f);
    }
    Rgb operator()(const CheckerTexture& t) const {
        const Vec2 at = laid(t.uv, place.uv);
        const auto sum = std::int64_t(std::floor(at.x)) + std::int64_t(std::floor(at.y));
        return of(sum % 2 == 0 ? t.even : t.odd);
    }
    Rgb operator()(const ProductTexture& t) const { return of(t.first) * of(t.second); }
    Rgb operator()(const MixTexture& t) const {
        const Rgb amount = of(t.amount);
        return of(t.first) * (Rgb{1, 1, 1} - amount) + of(t.second) * amount;
    }
    Rgb operator()(VertexColour) const { return place.vertex_colour; }
    Rgb operator()(const GreyTexture& t) const {
        const Rgb colour = of(t.texture);
        return grey(t.by == GreyTexture::By::mean ? (colour.r + colour.g + colour.b) / 3 : luminance(colour));
    }
    Rgb operator()(const ProjectedTexture& t) const {
        TexturePlace there = place;
        there.uv = projected(t, place.position);
        return value_at(textures, t.texture, there);
    }
    Rgb operator()(VertexAlpha) const { return grey(place.vertices.alpha()); }
    Rgb operator()(const OtherUvTexture& t) const {
        TexturePlace there = place;
        there.uv = place.vertices.uv(t.set);
        return value_at(textures, t.texture, there);
    }
    Rgb operator()(const CubesTexture& t) const {
        const Vec3 at = transform_point(t.from_world, place.position);
        const auto cube = [](float x) { return std::int64_t(std::floor(tame(x))); };
        return of((cube(at.x) + cube(at.y) + cube(at.z)) % 2 == 0 ? t.even : t.odd);
    }
    Rgb operator()(const DotsTexture& t) const { return of(in_dot(laid(t.uv, place.uv)) ? t.dots : t.around); }
    Rgb operator()(const DirectionTexture& t) const {
        const float along = std::min(std::fabs(dot(place.normal, t.direction)), 1.0f);
        return of(t.along) * along + of(t.across) * (1 - along);
    }
    Rgb operator()(const NoiseTexture& t) const {
        const Vec3 at = transform_point(t.from_world, place.position);
        using Kind = NoiseTexture::Kind;
        return grey(t.kind == Kind::fractal      ? fractal_noise(at, t.octaves, t.roughness)
                    : t.kind == Kind::turbulence ? turbulence(at, t.octaves, t.roughness)
                                                 : wind_waves(at));
    }
    Rgb operator()(const MarbleTexture& t) const {
        return marble(transform_point(t.from_world, place.position), t.octaves, t.roughness, t.variation);
    }
};

}  // namespace

Rgb value_at(std::span<const Texture> textures, TextureId texture, const TexturePlace& place) {
    const Texture& t = textures[texture];
    Rgb value = t.scale;
    if (!is_constant(t)) value = value * std::visit(Pattern{textures, place}, t.pattern);
    return t.invert ? Rgb{1, 1, 1} - value : value;
}

Rgb look_up(std::span<const Texture> textures, TextureId texture, const TexturePlace& place) {
    const Rgb value = value_at(textures, texture, place);
    return {std::max(0.0f, value.r), std::max(0.0f, value.g), std::max(0.0f, value.b)};
}

PictureLines lines_of(const ImageTexture& texture, Vec2 uv) {
    if (!texture.image || texture.image->empty()) return {};
    const Image& image = *texture.image;
    const Vec2 at = laid(texture.uv, uv);
    const float left = std::floor(at.x * float(image.width) - 0.5f);
    const float top = std::floor((1 - at.y) * float(image.height) - 0.5f);
    const auto x = wrapped(std::int64_t(left), image.width, texture.wrap_u);
    const auto row = [&](float y) -> const void* {
        const auto j = wrapped(std::int64_t(y), image.height, texture.wrap_v);
        return x < 0 || j < 0 ? nullptr : image.where(std::uint32_t(x), std::uint32_t(j));
    };
    return {row(top), row(top + 1)};
}

bool depends_on_place(std::span<const Texture> textures, TextureId texture) {
    const auto& pattern = textures[texture].pattern;
    const auto is = [&]<class... Kind>(std::variant<Kind...>*) {
        return (std::holds_alternative<Kind>(pattern) || ...);
    };
    using Solid = std::variant<ProjectedTexture, CubesTexture, DirectionTexture, NoiseTexture, MarbleTexture>;
    if (is(static_cast<Solid*>(nullptr))) return true;
    const std::vector<TextureId> inputs = inputs_of(textures[texture]);
    return std::any_of(inputs.begin(), inputs.end(),
                       [&](TextureId input) { return depends_on_place(textures, input); });
}

bool is_constant(const Texture& texture) { return std::holds_alternative<std::monostate>(texture.pattern); }

std::vector<TextureId> inputs_of(const Texture& texture) {
    std::vector<TextureId> inputs;
    visit_each<TextureId>(texture, [&](TextureId input) { inputs.push_back(input); });
    return inputs;
}

void check_textures(std::span<const Texture> textures) {
    for (std::size_t i = 0; i < textures.size(); ++i)
        for (const TextureId input : inputs_of(textures[i]))
            if (input >= i)
                throw Error("scene", "texture " + std::to_string(i) + " names one that doesn't stand before it");
}

}  // namespace lightnet
