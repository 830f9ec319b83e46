// Mitsuba's textures.
#pragma once

#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "core/readers/mitsuba/properties.hpp"

namespace lightnet::mitsuba {

/// Makes the textures of one scene; what several materials refer to is made once.
class Textures {
public:
    explicit Textures(const Context& context) : context_(context) {}

    /// The colour or texture that is the property `name`; none: not given.
    std::optional<TextureId> maybe(Properties& properties, std::string_view name);
    TextureId get(Properties& properties, std::string_view name, Rgb fallback);
    TextureId get(Properties& properties, std::string_view name, float fallback) {
        return get(properties, name, Rgb{fallback, fallback, fallback});
    }
    /// A colour, a texture, or a reference to one. What is wrong is reported and grey.
    TextureId of(const Node& node);
    /// As get() and of(), for one number: of colours it is the luminance, before version 2 their mean.
    TextureId number(Properties& properties, std::string_view name, float fallback);
    TextureId number_of(const Node& node) { return as_number(of(node)); }
    /// As of(), where what it covers shines: colours in it are light.
    TextureId of_light(const Node& node);

    const Context& context() const { return context_; }

private:
    Rgb colour(const Node& node) const;
    TextureId make(const Node& node);
    TextureId bitmap(Properties& properties);
    TextureId checkerboard(Properties& properties);
    TextureId scaled(Properties& properties);
    TextureId raw(Properties& properties);
    bool is_coloured(const Texture& texture) const;
    TextureId as_number(TextureId colours);

    const Context& context_;
    bool shines_ = false;                                                    // what is being made
    std::map<std::pair<const Node*, bool>, std::optional<TextureId>> made_;  // by node and shines_; none: being made
};

}  // namespace lightnet::mitsuba
