#include "core/readers/mitsuba/textures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/readers/images/image_facts.hpp"
#include "core/readers/mitsuba/colours.hpp"
#include "core/readers/mitsuba/transforms.hpp"
#include "core/scene/textures/look_up.hpp"

namespace lightnet::mitsuba {
namespace {

Wrap wrap_of(Properties& properties, const std::string& name, Wrap fallback) {
    const std::string word = properties.text(name, "");
    if (word.empty()) return fallback;
    if (word == "repeat") return Wrap::repeat;
    if (word == "mirror") return Wrap::mirror;
    if (word == "clamp") return Wrap::clamp;
    if (word == "zero") return Wrap::black;
    if (word == "one") {
        properties.context().warn(properties.node(), "wrap mode 'one' is taken as 'clamp'");
        return Wrap::clamp;
    }
    properties.context().error(properties.node(), fmt::format("unknown wrap mode '{}'", word.substr(0, 32)));
    return fallback;
}

Encoding encoding_of(Properties& properties) {
    if (properties.boolean("raw", false)) return {Encoding::Curve::linear, 1};
    const float gamma = properties.number("gamma", -1);
    if (gamma == 1) return {Encoding::Curve::linear, 1};
    return gamma > 0 ? Encoding{Encoding::Curve::gamma, gamma} : Encoding{};
}

ImageTexture::Channel channel_of(Properties& properties) {
    const std::string word = properties.text("channel", "");
    if (word == "r" || word == "x") return ImageTexture::Channel::red;
    if (word == "g" || word == "y") return ImageTexture::Channel::green;
    if (word == "b" || word == "z") return ImageTexture::Channel::blue;
    if (word == "a" || word == "w") return ImageTexture::Channel::alpha;
    return ImageTexture::Channel::colour;
}

}  // namespace

std::optional<TextureId> Textures::maybe(Properties& properties, std::string_view name) {
    const Node* given = properties.find(name);
    if (!given) return std::nullopt;
    const TextureId made = of(*given);
    const Texture& texture = context_.assets.scene().textures[made];
    if (name == "reflectance" && std::holds_alternative<std::monostate>(texture.pattern) &&
        max_component(texture.scale) > 1)
        context_.warn(*given, "'reflectance' is above 1: no surface reflects more light than it gets, and 1 is taken");
    return made;
}

TextureId Textures::get(Properties& properties, std::string_view name, Rgb fallback) {
    const auto given = maybe(properties, name);
    return given ? *given : context_.assets.colour(fallback);
}

TextureId Textures::number(Properties& properties, std::string_view name, float fallback) {
    return as_number(get(properties, name, fallback));
}

bool Textures::is_coloured(const Texture& texture) const {
    if (texture.scale.r != texture.scale.g || texture.scale.g != texture.scale.b) return true;
    if (const auto* image = std::get_if<ImageTexture>(&texture.pattern))
        return image->channel == ImageTexture::Channel::colour && lightnet::is_coloured(*image->image);
    const auto inputs = inputs_of(texture);
    return std::holds_alternative<VertexColour>(texture.pattern) ||
           std::any_of(inputs.begin(), inputs.end(),
                       [&](TextureId input) { return is_coloured(context_.assets.scene().textures[input]); });
}

// Mitsuba's Texture::eval_1(), in version 0.6 Spectrum::average()
TextureId Textures::as_number(TextureId colours) {
    Texture texture = context_.assets.scene().textures[colours];
    if (!is_coloured(texture)) return colours;
    const bool older = context_.document.version < 2;
    using By = GreyTexture::By;
    if (is_constant(texture)) {
        const Rgb c = texture.scale;
        texture.scale = Rgb{1, 1, 1} * (older ? (c.r + c.g + c.b) / 3 : luminance(c));
    } else {
        texture = {{1, 1, 1}, GreyTexture{colours, older ? By::mean : By::luminance}, false};
    }
    return context_.assets.add(texture);
}

TextureId Textures::of(const Node& node) {
    const Node* target = context_.resolved(node);
    if (!target) return context_.assets.grey(0.5f);
    if (is_colour(*target)) return context_.assets.colour(colour(*target));
    const auto [entry, fresh] = made_.try_emplace({target, shines_});
    if (!fresh && !entry->second) context_.error(node, fmt::format("texture '{}' refers to itself", target->id));
    if (!fresh) return entry->second.value_or(context_.assets.grey(0.5f));
    const TextureId made = make(*target);
    made_[{target, shines_}] = made;
    return made;
}

TextureId Textures::of_light(const Node& node) {
    const bool before = std::exchange(shines_, true);
    const TextureId made = of(node);
    shines_ = before;
    return made;
}

Rgb Textures::colour(const Node& node) const {
    constexpr Rgb grey{0.5f, 0.5f, 0.5f};
    return shines_ ? light_of(node, context_).value_or(LightColour{grey}).rgb
                   : surface_of(node, context_).value_or(SurfaceColour{grey}).rgb;
}

TextureId Textures::make(const Node& node) {
    Properties properties(node, context_);
    if (node.tag != "texture") {
        properties.ignore_all();
        context_.error(node, fmt::format("a colour or a texture expected, not <{}>", node.tag));
        return context_.assets.grey(0.5f);
    }
    if (node.type == "bitmap") return bitmap(properties);
    if (node.type == "checkerboard") return checkerboard(properties);
    if (node.type == "scale") return scaled(properties);
    if (node.type == "rawconstant") return raw(properties);
    if (node.type == "vertexcolors") return context_.assets.add({{1, 1, 1}, VertexColour{}, false});
    if (node.type == "mesh_attribute") {
        const float scale = properties.number("scale", 1);
        const std::string name = properties.text("name", "");
        if (name.starts_with("vertex_") || name.starts_with("face_"))  // the shape has it: see attributes_in()
            return context_.assets.add({{scale, scale, scale}, VertexColour{}, false});
    }
    properties.ignore_all();
    context_.warn(node, fmt::format("texture '{}' is not supported: grey is taken", node.type));
    return context_.assets.grey(0.5f);
}

TextureId Textures::bitmap(Properties& properties) {
    properties.ignore({"max_anisotropy", "cache", "accel", "format"});
    ImageTexture pattern;
    const Node* file = properties.find("filename");
    const Encoding encoding = encoding_of(properties);
    const std::string filter = properties.text("filter_type", "bilinear");
    pattern.nearest = filter == "nearest";
    pattern.wrap_u = pattern.wrap_v = wrap_of(properties, "wrap_mode", Wrap::repeat);
    pattern.wrap_u = wrap_of(properties, "wrap_mode_u", pattern.wrap_u);
    pattern.wrap_v = wrap_of(properties, "wrap_mode_v", pattern.wrap_v);
    pattern.channel = channel_of(properties);
    pattern.uv = uv_transform(properties, false);
    if (!file) {
        context_.error(properties.node(), "a bitmap needs a 'filename'");
        return context_.assets.grey(0.5f);
    }
    pattern.image =
        context_.assets.picture(context_.path(std::string(file->attribute("value")), *file), encoding, file->where);
    if (!pattern.image) return context_.assets.grey(0.5f);
    return context_.assets.add({{1, 1, 1}, pattern, false});
}

TextureId Textures::checkerboard(Properties& properties) {
    CheckerTexture squares;
    squares.even = get(properties, "color0", 0.4f);
    squares.odd = get(properties, "color1", 0.2f);
    squares.uv = uv_transform(properties, true);
    // Mitsuba's squares have a side of one half
    squares.uv.scale = squares.uv.scale * 2;
    squares.uv.offset = squares.uv.offset * 2;
    return context_.assets.add({{1, 1, 1}, squares, false});
}

/// Numbers as they are, one or three.
TextureId Textures::raw(Properties& properties) {
    const Node* value = properties.find("value");
    if (!value) context_.error(properties.node(), fmt::format("{} needs a 'value'", properties.owner()));
    const auto numbers = value ? triple(*value, context_, 0) : std::nullopt;
    return numbers ? context_.assets.colour({numbers->x, numbers->y, numbers->z}) : context_.assets.grey(0.5f);
}

TextureId Textures::scaled(Properties& properties) {
    const Rgb scale = surface_of(properties, "scale", {1, 1, 1}).rgb;
    const auto nested = properties.objects("texture");
    if (nested.empty()) {
        const Node* value = properties.find("value");
        return context_.assets.colour((value && is_colour(*value) ? colour(*value) : Rgb{1, 1, 1}) * scale);
    }
    Texture copy = context_.assets.scene().textures[of(*nested[0])];
    copy.scale *= scale;
    return context_.assets.add(copy);
}

}  // namespace lightnet::mitsuba
