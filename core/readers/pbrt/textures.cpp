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

void Textures::define(const std::string& name, const std::string& kind, const std::string& type, const Matrix& to_world,
                      Parameters& parameters) {
    const bool colour = kind == "spectrum" || (kind == "color" && sources_.older());
    if (kind != "float" && !colour) {
        parameters.error(fmt::format("a texture is of kind 'float' or 'spectrum', not '{}'{}", kind,
                                     kind == "color" ? " (did you mean 'spectrum'?)" : ""));
        return;
    }
    Named& named = colour ? spectra_ : floats_;
    if (named.contains(name)) {
        const std::string what = "a texture of that name and kind is there already";
        sources_.older() ? parameters.warn(what + ": from here on this one is meant") : parameters.error(what);
    }
    to_world_ = to_world, from_world_ = inverse(to_world);
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
    if (type == "uv" && sources_.older()) return unsupported(type, parameters, {0.5f, 0.5f, 0});
    if (type == "ptex") return unsupported(type, parameters, middle_grey);
    static const std::vector<std::string> known{"bilerp", "checkerboard", "constant", "directionmix", "dots",
                                                "fbm",    "imagemap",     "marble",   "mix",          "ptex",
                                                "scale",  "windy",        "wrinkled"};
    parameters.ignore_all();
    parameters.error(fmt::format("unknown class of texture '{}'{}", type, did_you_mean(type, known)));
    return std::nullopt;
}

// Asked for by those alone that lie in the world.
Matrix Textures::from_world(const Parameters& parameters) const {
    if (!from_world_) parameters.warn("it stands under a singular transform: it lies as the world does");
    return from_world_.value_or(Matrix{});
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
    if (mapping == "spherical")
        return {{1, 1, 1}, ProjectedTexture{add(std::move(texture)), By::sphere, from_world(parameters)}};
    if (mapping == "cylindrical")
        return {{1, 1, 1}, ProjectedTexture{add(std::move(texture)), By::cylinder, from_world(parameters)}};
    if (mapping == "planar") {
        const Vec3 u = vector_of(parameters, "v1", {1, 0, 0}), v = vector_of(parameters, "v2", {0, 1, 0});
        Matrix onto;
        onto.m[0] = {u.x, u.y, u.z, parameters.number("udelta", 0)};
        onto.m[1] = {v.x, v.y, v.z, parameters.number("vdelta", 0)};
        if (!sources_.older()) onto = onto * from_world(parameters);  // pbrt-v3 looks at the world's own axes
        return {{1, 1, 1}, ProjectedTexture{add(std::move(texture)), By::plane, onto}};
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
    NoiseTexture pattern{kind, 8, 0.5f, from_world(parameters)};
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
                          parameters.number("variation", 0.2f), scaling(scale, scale, scale) * from_world(parameters)},
            false};
}

Texture Textures::imagemap(Parameters& parameters, ImageTexture::Channel channel) {
    ImageTexture pattern;
    pattern.channel = channel;
    pattern.uv = laid(parameters);
    const Encoding encoding = encoding_of(parameters);
    const std::string file = parameters.file("filename");
    if (file.empty())
        parameters.error("parameter 'filename' is missing");
    else
        pattern.image = pictures_.get(file, encoding, parameters.where());
    pattern.wrap_u = pattern.wrap_v = wrap_of(parameters);
    pattern.nearest = nearest(parameters);
    const Rgb scale = all(parameters.number("scale", 1));
    const bool invert = !sources_.older() && parameters.boolean("invert", false);
    if (sources_.older()) parameters.ignore({"trilinear"});
    if (!pattern.image) return {middle_grey, {}, false};
    return {scale, std::move(pattern), invert};
}

Encoding Textures::encoding_of(Parameters& parameters) {
    if (sources_.older()) {
        const bool gamma = parameters.boolean("gamma", true);  // of pictures of eight bits
        return gamma ? Encoding{} : Encoding{Encoding::Curve::linear, 1};
    }
    const std::string word = parameters.text("encoding", "sRGB");
    if (word == "sRGB") return {};
    if (word == "linear") return {Encoding::Curve::linear, 1};
    float gamma = 0;
    if (word.starts_with("gamma ")) std::from_chars(word.data() + 6, word.data() + word.size(), gamma);
    if (gamma > 0 && std::isfinite(gamma)) return {Encoding::Curve::gamma, gamma};
    parameters.error(fmt::format("unknown encoding '{}' (there are 'sRGB', 'linear' and 'gamma 2.2')", word));
    return {};
}

Texture Textures::scale(Named& named, Parameters& parameters) {
    const bool older = sources_.older();
    const TextureId base = input(named, parameters, older ? "tex1" : "tex", 1);
    // of pbrt-v4 a number, whatever kind the product is
    const TextureId factor = older ? input(named, parameters, "tex2", 1) : number_or(parameters, "scale", 1);
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
    if (sources_.older()) parameters.ignore({"aamode"});
    if (dimension == 3) return {{1, 1, 1}, CubesTexture{even, odd, from_world(parameters)}, false};
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
    if (parameters.lenient() && given->type != Type::rgb && given->type != Type::spectrum) {
        parameters.warn_type(*given, "rgb");
        return all(fallback);
    }
    return surface_of(*given, Use::index, sources_).value_or(SurfaceColour{all(fallback)}).rgb;
}

TextureId Textures::input(Named& named, Parameters& parameters, std::string_view name, float fallback) {
    const Parameter* given = parameters.find(name);
    if (given && given->type == Type::texture) {
        const auto found = found_or_none(named, *given);
        return found ? *found : constant(all(fallback));
    }
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
        const std::string what =
            fmt::format("there is no {} texture '{}' above{}", number ? "float" : "spectrum", name,
                        other ? fmt::format(" (that one is of kind '{}')", number ? "spectrum" : "float")
                              : did_you_mean(name, names_of(named)));
        if (sources_.older())
            sources_.report.warn(parameter.where,
                                 what + fmt::format(": '{}' is as if it were not given", parameter.name));
        else
            sources_.report.error(parameter.where, what);
    } else {
        sources_.report.error(parameter.where, fmt::format("parameter '{}' needs one texture", parameter.name));
    }
    return std::nullopt;
}

}  // namespace lightnet::pbrt
