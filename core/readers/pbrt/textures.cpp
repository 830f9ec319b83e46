#include "core/readers/pbrt/textures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/pbrt/transforms.hpp"

namespace lightnet::pbrt {
namespace {

constexpr Rgb middle_grey{0.5f, 0.5f, 0.5f};

Rgb all(float value) { return {value, value, value}; }

template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value, std::less<>>& named) {
    std::vector<std::string> names;
    for (const auto& [name, value] : named) names.push_back(name);
    return names;
}

/// How `mapping` "uv" lays a texture over the surface; others ask for no scale, see projected().
UvTransform laid(Parameters& parameters) {
    if (parameters.text("mapping", "uv") != "uv") return {};
    return {{parameters.number("uscale", 1), parameters.number("vscale", 1)},
            {parameters.number("udelta", 0), parameters.number("vdelta", 0)},
            0};
}

// pbrt's own vectors, or its fallbacks.
Vec3 vector_of(Parameters& parameters, std::string_view name, Vec3 fallback) {
    const auto given = parameters.triples(name, Type::vector3);
    return given.size() == 1 ? given[0] : fallback;
}

Wrap wrap_of(Parameters& parameters) {
    static const std::map<std::string, Wrap> wraps{
        {"repeat", Wrap::repeat}, {"clamp", Wrap::clamp}, {"black", Wrap::black}, {"octahedralsphere", Wrap::repeat}};
    const std::string word = parameters.text("wrap", "repeat");
    if (const auto found = wraps.find(word); found != wraps.end()) return found->second;
    parameters.error(fmt::format("unknown wrap '{}'{}", word, did_you_mean(word, {"repeat", "clamp", "black"})));
    return Wrap::repeat;
}

bool nearest(Parameters& parameters) {
    static const std::vector<std::string> known{"point", "bilinear", "trilinear", "EWA", "ewa"};
    const std::string word = parameters.text("filter", "bilinear");
    if (std::find(known.begin(), known.end(), word) == known.end())
        parameters.error(fmt::format("unknown filter '{}'{}", word, did_you_mean(word, known)));
    parameters.ignore({"maxanisotropy"});
    return word == "point";
}

}  // namespace

TextureId Textures::add(Texture texture) {
    scene_.textures.push_back(std::move(texture));
    return static_cast<TextureId>(scene_.textures.size() - 1);
}

void Textures::finish() {
    pictures_.finish();
    std::map<const Image*, bool> translucent;
    const auto is_translucent = [&](const Image* image) {
        const auto [place, fresh] = translucent.try_emplace(image, false);
        if (fresh && image->has_alpha())
            for (std::uint32_t y = 0; y < image->height && !place->second; ++y)
                for (std::uint32_t x = 0; x < image->width && !place->second; ++x)
                    place->second = image->alpha(x, y) != 1;
        return place->second;
    };
    for (auto& texture : scene_.textures)
        if (auto* picture = std::get_if<ImageTexture>(&texture.pattern);
            picture && picture->channel == ImageTexture::Channel::mean && is_translucent(picture->image.get()))
            picture->channel = ImageTexture::Channel::alpha;
}

void Textures::define(const std::string& name, const std::string& kind, const std::string& type, const Matrix& to_world,
                      Parameters& parameters) {
    if (kind != "float" && kind != "spectrum") {
        parameters.error(fmt::format("a texture is of kind 'float' or 'spectrum', not '{}'{}", kind,
                                     kind == "color" ? " (did you mean 'spectrum'?)" : ""));
        return;
    }
    Named& named = kind == "float" ? floats_ : spectra_;
    if (named.contains(name)) parameters.error("a texture of that name and kind is there already");
    const auto from_world = inverse(to_world);
    if (!from_world) parameters.error("the transform here has no inverse");
    to_world_ = to_world, from_world_ = from_world.value_or(Matrix{});
    auto texture = make(type, named, parameters);
    named.insert_or_assign(name, add(texture ? std::move(*texture) : Texture{middle_grey, {}, false}));
}

std::optional<Texture> Textures::make(const std::string& type, Named& named, Parameters& parameters) {
    if (type == "imagemap")
        return projected(
            imagemap(parameters, &named == &floats_ ? ImageTexture::Channel::mean : ImageTexture::Channel::colour),
            parameters);
    if (type == "constant") return scene_.textures[input(named, parameters, "value", 1)];
    if (type == "scale") return scale(named, parameters);
    if (type == "mix") return mix(named, parameters);
    if (type == "directionmix") return direction_mix(named, parameters);
    if (type == "checkerboard") return checkerboard(named, parameters);
    if (type == "dots") return projected(dots(named, parameters), parameters);
    if (type == "bilerp") return projected(bilinear(parameters), parameters);
    if (type == "marble") return marble(parameters);
    if (type == "fbm") return noise(NoiseTexture::Kind::fractal, parameters);
    if (type == "wrinkled") return noise(NoiseTexture::Kind::turbulence, parameters);
    if (type == "windy") return noise(NoiseTexture::Kind::wind, parameters);
    if (type == "ptex") return unsupported(type, parameters, middle_grey);
    static const std::vector<std::string> known{"bilerp", "checkerboard", "constant", "directionmix", "dots",
                                                "fbm",    "imagemap",     "marble",   "mix",          "ptex",
                                                "scale",  "windy",        "wrinkled"};
    parameters.ignore_all();
    parameters.error(fmt::format("unknown class of texture '{}'{}", type, did_you_mean(type, known)));
    return std::nullopt;
}

Texture Textures::unsupported(const std::string& type, Parameters& parameters, Rgb mean) {
    parameters.ignore_all();
    sources_.report.warn(parameters.where(), fmt::format("textures of class '{}' are not supported: one colour, about "
                                                         "their mean, stands for each",
                                                         type));
    return {mean, {}, false};
}

// What lies over texture coordinates, laid by `mapping`. A plane's vectors are a part of the way into its space.
Texture Textures::projected(Texture texture, Parameters& parameters) {
    using By = ProjectedTexture::By;
    const std::string mapping = parameters.text("mapping", "uv");
    if (mapping == "uv") return texture;
    if (mapping == "spherical") return {{1, 1, 1}, ProjectedTexture{add(std::move(texture)), By::sphere, from_world_}};
    if (mapping == "cylindrical")
        return {{1, 1, 1}, ProjectedTexture{add(std::move(texture)), By::cylinder, from_world_}};
    if (mapping == "planar") {
        const Vec3 u = vector_of(parameters, "v1", {1, 0, 0}), v = vector_of(parameters, "v2", {0, 1, 0});
        Matrix onto;
        onto.m[0] = {u.x, u.y, u.z, parameters.number("udelta", 0)};
        onto.m[1] = {v.x, v.y, v.z, parameters.number("vdelta", 0)};
        return {{1, 1, 1}, ProjectedTexture{add(std::move(texture)), By::plane, onto * from_world_}};
    }
    static const std::vector<std::string> known{"cylindrical", "planar", "spherical", "uv"};
    parameters.error(fmt::format("unknown mapping '{}'{}", mapping, did_you_mean(mapping, known)));
    return texture;
}

std::int32_t Textures::octaves(Parameters& parameters) const {
    constexpr int most = 32;  // beyond, floats have no digits left for their places
    const int count = parameters.integer("octaves", 8);
    if (count < 0 || count > most) parameters.error(fmt::format("'octaves' is {}, not 0 to {}", count, most));
    return std::clamp(count, 0, most);
}

Texture Textures::noise(NoiseTexture::Kind kind, Parameters& parameters) {
    NoiseTexture pattern{kind, 8, 0.5f, from_world_};
    if (kind != NoiseTexture::Kind::wind) {
        pattern.octaves = octaves(parameters);
        pattern.roughness = parameters.number("roughness", 0.5f);
    }
    return {{1, 1, 1}, pattern, false};
}

Texture Textures::marble(Parameters& parameters) {
    const float scale = parameters.number("scale", 1);
    return {{1, 1, 1},
            MarbleTexture{octaves(parameters), parameters.number("roughness", 0.5f),
                          parameters.number("variation", 0.2f), scaling(scale, scale, scale) * from_world_},
            false};
}

Texture Textures::imagemap(Parameters& parameters, ImageTexture::Channel channel) {
    ImageTexture pattern;
    pattern.channel = channel;
    pattern.uv = laid(parameters);
    const Encoding encoding = encoding_of(parameters);
    const std::string file = parameters.text("filename", "");
    if (file.empty())
        parameters.error("parameter 'filename' is missing");
    else
        pattern.image = pictures_.get(file, encoding, parameters.where());
    pattern.wrap_u = pattern.wrap_v = wrap_of(parameters);
    pattern.nearest = nearest(parameters);
    const Rgb scale = all(parameters.number("scale", 1));
    const bool invert = parameters.boolean("invert", false);
    if (!pattern.image) return {middle_grey, {}, false};
    return {scale, std::move(pattern), invert};
}

Encoding Textures::encoding_of(Parameters& parameters) {
    const std::string word = parameters.text("encoding", "sRGB");
    if (word == "sRGB") return {};
    if (word == "linear") return {Encoding::Curve::linear, 1};
    float gamma = 0;
    if (word.starts_with("gamma ")) std::from_chars(word.data() + 6, word.data() + word.size(), gamma);
    if (gamma > 0 && std::isfinite(gamma)) return {Encoding::Curve::gamma, gamma};
    parameters.error(fmt::format("unknown encoding '{}' (there are 'sRGB', 'linear' and 'gamma 2.2')", word));
    return {};
}

TextureId Textures::scaled(TextureId texture, float factor) {
    if (factor == 1) return texture;
    Texture copy = scene_.textures[texture];
    if (!copy.invert) {
        copy.scale *= factor;
        return add(std::move(copy));
    }
    return add({{1, 1, 1}, ProductTexture{texture, constant(all(factor))}, false});
}

std::optional<Rgb> Textures::constant_value(TextureId id) const {
    const Texture& texture = scene_.textures[id];
    if (!std::holds_alternative<std::monostate>(texture.pattern)) return std::nullopt;
    return texture.invert ? Rgb{1, 1, 1} - texture.scale : texture.scale;
}

Texture Textures::scale(Named& named, Parameters& parameters) {
    const TextureId base = input(named, parameters, "tex", 1);
    const TextureId factor = number_or(parameters, "scale", 1);  // a number, whatever kind the product is
    const auto both = [&](TextureId pattern, Rgb by) {
        Texture texture = scene_.textures[pattern];
        texture.scale *= by;
        return texture;
    };
    if (const auto by = constant_value(factor); by && !scene_.textures[base].invert) return both(base, *by);
    if (const auto by = constant_value(base); by && !scene_.textures[factor].invert) return both(factor, *by);
    return {{1, 1, 1}, ProductTexture{base, factor}, false};
}

Texture Textures::mix(Named& named, Parameters& parameters) {
    const TextureId first = input(named, parameters, "tex1", 0), second = input(named, parameters, "tex2", 1);
    return {{1, 1, 1}, MixTexture{first, second, number_or(parameters, "amount", 0.5f)}, false};
}

Texture Textures::direction_mix(Named& named, Parameters& parameters) {
    const TextureId first = input(named, parameters, "tex1", 0), second = input(named, parameters, "tex2", 1);
    const Vec3 direction = transform_direction(to_world_, vector_of(parameters, "dir", {0, 1, 0}));
    const float size = length(direction);
    if (!(size > 0)) parameters.error("'dir' has no direction");
    return {{1, 1, 1}, DirectionTexture{first, second, size > 0 ? direction / size : Vec3{0, 1, 0}}, false};
}

Texture Textures::checkerboard(Named& named, Parameters& parameters) {
    const TextureId even = input(named, parameters, "tex1", 1), odd = input(named, parameters, "tex2", 0);
    const int dimension = parameters.integer("dimension", 2);
    if (dimension == 3) return {{1, 1, 1}, CubesTexture{even, odd, from_world_}, false};
    if (dimension != 2) parameters.error(fmt::format("a checkerboard has 2 or 3 dimensions, not {}", dimension));
    return projected({{1, 1, 1}, CheckerTexture{even, odd, laid(parameters)}, false}, parameters);
}

// In pbrt's pictures the dots have what it calls `outside`, and `inside` lies around them.
Texture Textures::dots(Named& named, Parameters& parameters) {
    const TextureId inside = input(named, parameters, "inside", 1), outside = input(named, parameters, "outside", 0);
    return {{1, 1, 1}, DotsTexture{outside, inside, laid(parameters)}, false};
}

// The colours are the pixels of an image of two by two; its pixels' centres lie at 1/4 and 3/4.
Texture Textures::bilinear(Parameters& parameters) {
    const Rgb v00 = corner(parameters, "v00", 0), v01 = corner(parameters, "v01", 1);
    const Rgb v10 = corner(parameters, "v10", 0), v11 = corner(parameters, "v11", 1);
    ImageTexture pattern;
    pattern.image = std::make_shared<const Image>(Image{2, 2, {v01, v11, v00, v10}, {}});
    pattern.wrap_u = pattern.wrap_v = Wrap::clamp;
    const UvTransform uv = laid(parameters);
    pattern.uv = {uv.scale * 0.5f, {uv.offset.x * 0.5f + 0.25f, uv.offset.y * 0.5f + 0.25f}, 0};
    return {{1, 1, 1}, std::move(pattern), false};
}

Rgb Textures::corner(Parameters& parameters, std::string_view name, float fallback) {
    const Parameter* given = parameters.find(name);
    if (!given) return all(fallback);
    if (given->type == Type::number) return all(parameters.number(name, fallback));
    return surface_of(*given, Use::index, sources_).value_or(SurfaceColour{all(fallback)}).rgb;
}

TextureId Textures::input(Named& named, Parameters& parameters, std::string_view name, float fallback) {
    const Parameter* given = parameters.find(name);
    if (given && given->type == Type::texture) return find(named, *given).value_or(0);
    return constant(corner(parameters, name, fallback));
}

TextureId Textures::number_or(Parameters& parameters, std::string_view name, float fallback) {
    const auto given = maybe_number(parameters, name);
    return given ? *given : constant(all(fallback));
}

std::optional<TextureId> Textures::find(const Named& named, const Parameter& parameter) {
    if (parameter.texts.size() == 1) {
        if (const auto found = named.find(parameter.texts[0]); found != named.end()) return found->second;
        const bool number = &named == &floats_;
        const std::string& name = parameter.texts[0];
        const bool other = (number ? spectra_ : floats_).contains(name);
        sources_.report.error(
            parameter.where,
            fmt::format("there is no {} texture '{}' above{}", number ? "float" : "spectrum", name,
                        other ? fmt::format(" (that one is of kind '{}')", number ? "spectrum" : "float")
                              : did_you_mean(name, names_of(named))));
    } else {
        sources_.report.error(parameter.where, fmt::format("parameter '{}' needs one texture", parameter.name));
    }
    return std::nullopt;
}

std::optional<TextureId> Textures::maybe_colour(Parameters& parameters, std::string_view name, Use use) {
    const Parameter* given = parameters.find(name);
    if (!given) return std::nullopt;
    if (given->type == Type::texture) return find(spectra_, *given).value_or(0);
    return constant(surface_of(*given, use, sources_).value_or(SurfaceColour{middle_grey}).rgb);
}

TextureId Textures::colour(Parameters& parameters, std::string_view name, Rgb fallback, Use use) {
    const auto given = maybe_colour(parameters, name, use);
    return given ? *given : constant(fallback);
}

std::optional<TextureId> Textures::maybe_number(Parameters& parameters, std::string_view name) {
    const Parameter* given = parameters.find(name);
    if (!given) return std::nullopt;
    if (given->type == Type::texture) return find(floats_, *given).value_or(0);
    const auto number = parameters.maybe_number(name);
    return number ? std::optional(constant(all(*number))) : std::nullopt;
}

std::optional<TextureId> Textures::linear_image(const std::string& file, const SourceLine& where) {
    ImageTexture pattern;
    pattern.image = pictures_.get(file, {Encoding::Curve::linear, 1}, where);
    if (!pattern.image) return std::nullopt;
    return add({{1, 1, 1}, std::move(pattern), false});
}

}  // namespace lightnet::pbrt
