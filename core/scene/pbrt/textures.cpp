#include "core/scene/pbrt/textures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "core/scene/pbrt/baking.hpp"
#include "core/scene/textures.hpp"
#include "core/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

Texture constant(Rgb value) {
    Texture texture;
    texture.scale = value;
    return texture;
}

template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value, std::less<>>& named) {
    std::vector<std::string> names;
    for (const auto& [name, value] : named) names.push_back(name);
    return names;
}

/// Far outside, floats can't tell pixels apart, and integers would overflow.
float tame(float coordinate) { return std::isfinite(coordinate) ? std::clamp(coordinate, -0x1p20f, 0x1p20f) : 0.0f; }

const ImageTexture* picture_of(const Texture& texture) { return std::get_if<ImageTexture>(&texture.pattern); }

Rgb inverted(const Texture& texture, Rgb value) {
    if (texture.invert) value = Rgb{1, 1, 1} - value;
    return {std::max(value.r, 0.0f), std::max(value.g, 0.0f), std::max(value.b, 0.0f)};
}

/// How `mapping` "uv" lays a texture over the surface.
UvTransform laid(Parameters& parameters) {
    if (parameters.text("mapping", "uv") != "uv") parameters.warn("only the mapping 'uv' is supported and taken");
    UvTransform uv;
    uv.scale = {parameters.number("uscale", 1), parameters.number("vscale", 1)};
    uv.offset = {parameters.number("udelta", 0), parameters.number("vdelta", 0)};
    return uv;
}

}  // namespace

Rgb look_up(const Texture& texture, Vec2 uv) { return lightnet::look_up({&texture, 1}, 0, {uv, {1, 1, 1}}); }

Rgb mean_of(const Texture& texture) {
    const ImageTexture* picture = picture_of(texture);
    if (!picture) return inverted(texture, texture.scale);
    double r = 0, g = 0, b = 0;
    for (std::uint32_t y = 0; y < picture->image->height; ++y)
        for (std::uint32_t x = 0; x < picture->image->width; ++x) {
            const Rgb p = picture->image->colour(x, y);
            r += p.r, g += p.g, b += p.b;
        }
    const double n = double(picture->image->width) * picture->image->height;
    const Rgb mean{float(r / n), float(g / n), float(b / n)};
    return inverted(texture, texture.scale * mean);
}

void Textures::define(const std::string& name, const std::string& kind, const std::string& type,
                      Parameters& parameters) {
    if (kind != "float" && kind != "spectrum") {
        parameters.error(fmt::format("a texture is of kind 'float' or 'spectrum', not '{}'{}", kind,
                                     kind == "color" ? " (did you mean 'spectrum'?)" : ""));
        return;
    }
    Named& named = kind == "float" ? floats_ : spectra_;
    if (named.contains(name)) parameters.error("a texture of that name and kind is there already");
    Texture texture = sources_.report.full() ? constant({}) : make(type, named, parameters);
    if (kind == "float" && picture_of(texture))
        texture = bake({texture}, [](std::span<const Rgb> in) {
                      const float mean = (in[0].r + in[0].g + in[0].b) / 3;
                      return Rgb{mean, mean, mean};
                  }).texture;
    // made of others: not yet counted
    const ImageTexture* picture = picture_of(texture);
    const auto same = [&](const auto& known) { return known.second == picture->image; };
    if (picture && std::none_of(images_.begin(), images_.end(), same) && !room_for(*picture->image, parameters.where()))
        texture = constant({0.5f, 0.5f, 0.5f});
    named.insert_or_assign(name, std::move(texture));
}

Texture Textures::make(const std::string& type, Named& named, Parameters& parameters) {
    if (type == "imagemap") return imagemap(parameters);
    if (type == "constant") return input(named, parameters, "value", 1);
    if (type == "scale") return scale(named, parameters);
    if (type == "mix") return mix(named, parameters);
    if (type == "checkerboard") return checkerboard(named, parameters);
    static const std::vector<std::string> known{"imagemap", "constant", "scale", "mix", "checkerboard"};
    static const std::vector<std::string> unsupported{"bilerp", "directionmix", "dots",  "fbm",
                                                      "marble", "ptex",         "windy", "wrinkled"};
    parameters.ignore_all();
    if (std::find(unsupported.begin(), unsupported.end(), type) != unsupported.end())
        parameters.warn(fmt::format("textures of class '{}' are not supported; grey 0.5 stands for it", type));
    else
        parameters.error(fmt::format("unknown class of texture '{}'{}", type, did_you_mean(type, known)));
    return constant({0.5f, 0.5f, 0.5f});
}

Texture Textures::imagemap(Parameters& parameters) {
    parameters.ignore({"filter", "maxanisotropy"});  // a scene looks up pictures bilinearly
    ImageTexture picture;
    picture.uv = laid(parameters);
    const Encoding encoding = encoding_of(parameters);
    const std::string file = parameters.text("filename", "");
    if (file.empty())
        parameters.error("parameter 'filename' is missing");
    else
        picture.image = image(file, encoding, parameters.where());
    const std::string wrap = parameters.text("wrap", "repeat");
    if (wrap != "repeat" && wrap != "clamp" && wrap != "black" && wrap != "octahedralsphere")
        parameters.error(fmt::format("unknown wrap '{}'{}", wrap, did_you_mean(wrap, {"repeat", "clamp", "black"})));
    picture.wrap_u = picture.wrap_v = wrap == "clamp" ? Wrap::clamp : wrap == "black" ? Wrap::black : Wrap::repeat;
    const float scale = parameters.number("scale", 1);
    Texture texture;
    texture.scale = {scale, scale, scale};
    texture.invert = parameters.boolean("invert", false);
    if (!picture.image) return constant({0.5f, 0.5f, 0.5f});
    texture.pattern = std::move(picture);
    return texture;
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

Texture Textures::scale(Named& named, Parameters& parameters) {
    const Texture base = input(named, parameters, "tex", 1);
    const Parameter* factor_given = parameters.find("scale");
    const bool by_texture = factor_given && factor_given->type == Type::texture;
    Texture factor = constant({1, 1, 1});
    if (by_texture) {
        // the factor is a float texture, whatever kind the product is
        if (const Texture* found = find(floats_, *factor_given)) factor = *found;
    } else {
        const float number = parameters.number("scale", 1);
        factor = constant({number, number, number});
    }
    if (!base.invert && !factor.invert && (!picture_of(base) || !picture_of(factor))) {
        Texture product = picture_of(base) ? base : factor;
        product.scale = base.scale * factor.scale;
        return product;
    }
    const auto baked = bake({base, factor}, [](std::span<const Rgb> in) { return in[0] * in[1]; });
    if (!baked.exact) parameters.warn("a product of differently laid pictures is approximated by 1024 x 1024 pixels");
    return baked.texture;
}

Texture Textures::mix(Named& named, Parameters& parameters) {
    const Texture a = input(named, parameters, "tex1", 0), b = input(named, parameters, "tex2", 1);
    Texture amount = constant({0.5f, 0.5f, 0.5f});
    const Parameter* given = parameters.find("amount");
    if (given && given->type == Type::texture) {
        if (const Texture* found = find(floats_, *given)) amount = *found;
    } else {
        const float number = parameters.number("amount", 0.5f);
        amount = constant({number, number, number});
    }
    const auto baked = bake({a, b, amount}, [](std::span<const Rgb> in) {
        return in[0] * (Rgb{1, 1, 1} - in[2]) + in[1] * in[2];
    });
    if (!baked.exact) parameters.warn("a mix of differently laid pictures is approximated by 1024 x 1024 pixels");
    return baked.texture;
}

Texture Textures::checkerboard(Named& named, Parameters& parameters) {
    const Texture a = input(named, parameters, "tex1", 1), b = input(named, parameters, "tex2", 0);
    const UvTransform uv_laid = laid(parameters);
    if (parameters.integer("dimension", 2) != 2) parameters.warn("only checkerboards of dimension 2 are supported");
    const auto first = [](float s, float t) {
        return (std::int64_t(std::floor(tame(s))) + std::int64_t(std::floor(tame(t)))) % 2 == 0;
    };
    if (picture_of(a) || picture_of(b)) {
        parameters.warn("a checkerboard of pictures is approximated by 1024 x 1024 pixels");
        return paint(1024, [&](Vec2 uv) {
            const bool odd =
                !first(uv.x * uv_laid.scale.x + uv_laid.offset.x, uv.y * uv_laid.scale.y + uv_laid.offset.y);
            return look_up(odd ? b : a, uv);
        });
    }
    parameters.warn("the edges of a checkerboard are as sharp as a picture with 128 pixels for each field");
    Texture board = paint(256, [&](Vec2 uv) { return first(2 * uv.x, 2 * uv.y) ? a.scale : b.scale; });
    auto& picture = std::get<ImageTexture>(board.pattern);
    picture.uv.scale = uv_laid.scale * 0.5f;
    picture.uv.offset = uv_laid.offset * 0.5f;
    return board;
}

Texture Textures::input(Named& named, Parameters& parameters, std::string_view name, float fallback) {
    const Parameter* given = parameters.find(name);
    if (!given) return constant({fallback, fallback, fallback});
    if (given->type == Type::number) {
        const float value = parameters.number(name, fallback);
        return constant({value, value, value});
    }
    if (given->type == Type::texture) {
        const Texture* found = find(named, *given);
        return found ? *found : constant({fallback, fallback, fallback});
    }
    return constant(colour_of(*given, Use::index, sources_).value_or(Rgb{fallback, fallback, fallback}));
}

const Texture* Textures::find(const Named& named, const Parameter& parameter) {
    if (parameter.texts.size() == 1) {
        if (const auto found = named.find(parameter.texts[0]); found != named.end()) return &found->second;
        sources_.report.error(
            parameter.where,
            fmt::format("there is no {} texture '{}' above{}", &named == &floats_ ? "float" : "spectrum",
                        parameter.texts[0], did_you_mean(parameter.texts[0], names_of(named))));
    } else {
        sources_.report.error(parameter.where, fmt::format("parameter '{}' needs one texture", parameter.name));
    }
    return nullptr;
}

TextureId Textures::add(const Texture& texture) {
    scene_.textures.push_back(texture);
    return static_cast<TextureId>(scene_.textures.size() - 1);
}

std::optional<TextureId> Textures::maybe_colour(Parameters& parameters, std::string_view name, Use use) {
    const Parameter* given = parameters.find(name);
    if (!given) return std::nullopt;
    if (given->type == Type::texture) {
        const Texture* found = find(spectra_, *given);
        return add(found ? *found : constant({0.5f, 0.5f, 0.5f}));
    }
    return add(constant(colour_of(*given, use, sources_).value_or(Rgb{0.5f, 0.5f, 0.5f})));
}

TextureId Textures::colour(Parameters& parameters, std::string_view name, Rgb fallback, Use use) {
    const auto given = maybe_colour(parameters, name, use);
    return given ? *given : add(constant(fallback));
}

std::optional<float> Textures::number(Parameters& parameters, std::string_view name) {
    const Parameter* given = parameters.find(name);
    if (!given || given->type != Type::texture) return given ? parameters.maybe_number(name) : std::nullopt;
    const Texture* found = find(floats_, *given);
    if (!found) return std::nullopt;
    if (picture_of(*found))
        parameters.warn(
            fmt::format("parameter '{}' can't change over the surface; the mean of its texture is taken", name));
    return mean_of(*found).r;
}

bool Textures::room_for(const Image& image, const SourceLine& where) {
    constexpr std::uint64_t most = std::uint64_t{1} << 28;  // 3 GB
    if (pixels_ > most) return false;
    pixels_ += std::uint64_t{image.width} * image.height;
    if (pixels_ > most) sources_.report.error(where, "the pictures of the scene have more than 2^28 pixels in all");
    return pixels_ <= most;
}

std::shared_ptr<const Image> Textures::image(const std::string& name, const Encoding& encoding,
                                             const SourceLine& where) {
    const auto key = std::pair(sources_.path(name), fmt::format("{} {}", int(encoding.curve), encoding.gamma));
    if (const auto known = images_.find(key); known != images_.end()) return known->second;
    std::shared_ptr<const Image> decoded;
    if (const auto bytes = sources_.read(name, where)) try {
            decoded = std::make_shared<const Image>(read_image(**bytes, encoding));
        } catch (const Error& problem) {
            sources_.report.error(where, fmt::format("'{}': {}", name, problem.what()));
        }
    if (decoded && !room_for(*decoded, where)) decoded = nullptr;
    images_.emplace(key, decoded);
    return decoded;
}

}  // namespace lightnet::pbrt
