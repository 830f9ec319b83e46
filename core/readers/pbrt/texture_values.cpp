// Textures that parameters name: the colour or number that each stands for, and what is made of those that are there.
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "core/readers/images/image_facts.hpp"
#include "core/readers/pbrt/textures.hpp"

namespace lightnet::pbrt {
namespace {

Rgb one(float value) { return {value, value, value}; }

}  // namespace

void Textures::finish() {
    pictures_.finish();
    if (sources_.older()) return;  // pbrt-v3 knows of no alpha
    std::map<const Image*, bool> translucent;
    const auto shines_through = [&](const Image* image) {
        const auto [place, fresh] = translucent.try_emplace(image, false);
        if (fresh) place->second = is_translucent(*image);
        return place->second;
    };
    for (auto& texture : scene_.textures)
        if (auto* picture = std::get_if<ImageTexture>(&texture.pattern);
            picture && picture->channel == ImageTexture::Channel::mean && shines_through(picture->image.get()))
            picture->channel = ImageTexture::Channel::alpha;
}

TextureId Textures::mapped(TextureId id, float (*of)(float), const Parameters& parameters) {
    if (const auto everywhere = constant_value(id)) return constant(one(of(everywhere->r)));
    const Texture texture = scene_.textures[id];
    if (const auto* picture = std::get_if<ImageTexture>(&texture.pattern)) {
        pictures_.finish();
        ImageTexture made = *picture;
        std::vector<Rgb> pixels;
        for (std::uint32_t y = 0; y < picture->image->height; ++y)
            for (std::uint32_t x = 0; x < picture->image->width; ++x) {
                const Rgb c = picture->image->colour(x, y);
                pixels.push_back(one(of((c.r + c.g + c.b) / 3 * texture.scale.r)));
            }
        made.image = std::make_shared<const Image>(picture->image->width, picture->image->height, pixels);
        return add({{1, 1, 1}, std::move(made), false});
    }
    if (const auto* squares = std::get_if<CheckerTexture>(&texture.pattern); squares && texture.scale == one(1)) {
        CheckerTexture made = *squares;
        made.even = mapped(squares->even, of, parameters), made.odd = mapped(squares->odd, of, parameters);
        return add({{1, 1, 1}, made, false});
    }
    parameters.warn("a texture of this class is taken as the alpha of facets, not as a roughness");
    return id;
}

TextureId Textures::scaled(TextureId texture, float factor) {
    if (factor == 1) return texture;
    Texture copy = scene_.textures[texture];
    if (!copy.invert) {
        copy.scale *= factor;
        return add(std::move(copy));
    }
    return add({{1, 1, 1}, ProductTexture{texture, constant(one(factor))}, false});
}

std::optional<Rgb> Textures::constant_value(TextureId id) const {
    const Texture& texture = scene_.textures[id];
    if (!std::holds_alternative<std::monostate>(texture.pattern)) return std::nullopt;
    return texture.invert ? Rgb{1, 1, 1} - texture.scale : texture.scale;
}

// As pbrt-v3 does it: what has no texture of that name is as if it were not given.
std::optional<TextureId> Textures::found_or_none(const Named& named, const Parameter& parameter) {
    const auto found = find(named, parameter);
    return found || sources_.older() ? found : TextureId(0);
}

std::optional<TextureId> Textures::maybe_colour(Parameters& parameters, std::string_view name, Use use) {
    const Parameter* given = parameters.find(name);
    if (!given) return std::nullopt;
    if (given->type == Type::texture) return found_or_none(spectra_, *given);
    const bool colour = given->type == Type::rgb || given->type == Type::spectrum || given->type == Type::blackbody;
    if (parameters.lenient() && !colour) {
        parameters.warn_type(*given, "rgb");
        return std::nullopt;
    }
    return constant(surface_of(*given, use, sources_).value_or(SurfaceColour{Rgb{0.5f, 0.5f, 0.5f}}).rgb);
}

TextureId Textures::colour(Parameters& parameters, std::string_view name, Rgb fallback, Use use) {
    const auto given = maybe_colour(parameters, name, use);
    return given ? *given : constant(fallback);
}

std::optional<TextureId> Textures::maybe_number(Parameters& parameters, std::string_view name) {
    const Parameter* given = parameters.find(name);
    if (!given) return std::nullopt;
    if (given->type == Type::texture) return found_or_none(floats_, *given);
    const auto number = parameters.maybe_number(name);
    return number ? std::optional(constant(one(*number))) : std::nullopt;
}

std::optional<TextureId> Textures::linear_image(const std::string& file, const SourceLine& where) {
    ImageTexture pattern;
    pattern.image = pictures_.get(file, {Encoding::Curve::linear, 1}, where);
    if (!pattern.image) return std::nullopt;
    return add({{1, 1, 1}, std::move(pattern), false});
}

}  // namespace lightnet::pbrt
