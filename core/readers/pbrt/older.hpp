// One material of pbrt-v3 while it is made.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/readers/pbrt/older_materials.hpp"

namespace lightnet::pbrt {

constexpr Rgb older_white{1, 1, 1}, older_half{0.5f, 0.5f, 0.5f}, older_quarter{0.25f, 0.25f, 0.25f};

/// Makes one of them; what it is made from must outlive it.
class Older {
public:
    Older(Parameters& parameters, const OlderSources& sources)
        : parameters_(parameters),
          sources_(sources),
          textures_(sources.known.textures),
          bump_(textures_.maybe_number(parameters, "bumpmap")) {}

    Material matte() { return sum_of({diffuse(colour("Kd", older_half), sigma())}, parameters_, sources_); }
    Material plastic() {
        return sum_of(
            lit({diffuse(colour("Kd", older_quarter), 0), facets(colour("Ks", older_quarter), 1.5f, roughness())}),
            parameters_, sources_);
    }
    Material metal();
    Material mirror() { return made(smooth_metal(colour("Kr", {0.9f, 0.9f, 0.9f}))); }
    Material glass();
    Material uber();
    Material substrate();
    Material translucent();
    Material fourier();
    Material subsurface(const char* kd, Rgb fallback);
    Material disney();
    Material shiny_metal();
    Material measured();
    Material mix();
    Material nothing() { return made(NoMaterial{}); }

private:
    TextureId colour(const char* name, Rgb fallback, Use use = Use::surface) {
        return textures_.colour(parameters_, name, fallback, use);
    }
    Material made(AnyMaterial model) const {
        Material material;
        material.model = std::move(model);
        material.bump_map = bump_;
        return material;
    }
    float most_of(TextureId texture) const {
        const auto value = textures_.constant_value(texture);
        return value ? max_component(*value) : 1;
    }
    TextureId product(TextureId a, TextureId b) {
        for (const auto& [pattern, factor] : {std::pair{a, b}, std::pair{b, a}})
            if (const auto by = textures_.constant_value(factor); by && *by == older_white * by->r)
                return textures_.scaled(pattern, by->r);
        return textures_.add({older_white, ProductTexture{a, b}, false});
    }
    /// Those that send anything back.
    static std::vector<Reflection> lit(std::vector<Reflection> parts) {
        std::erase_if(parts, [](const Reflection& part) { return !(part.most > 0); });
        return parts;
    }

    float sigma();
    float number(const char* name, float fallback);
    float index();
    Roughness roughness(float fallback = 0.1f);
    Roughness roughness_along(TextureId u, TextureId v, bool remapped);
    ConductorMaterial smooth_metal(TextureId tint);

    Reflection diffuse(TextureId kd, float sigma) {
        return {most_of(kd), true, [this, kd, sigma](float gain) {
                    return made(DiffuseMaterial{textures_.scaled(kd, gain), sigma, std::nullopt});
                }};
    }
    /// By facets of glass whose inside is not seen: a metal of that index, without absorption.
    Reflection facets(TextureId ks, float eta, const Roughness& rough) {
        return {most_of(ks), false, [this, ks, eta, rough](float gain) {
                    const TextureId n = textures_.constant(older_white * eta), k = textures_.constant({});
                    return made(ConductorMaterial{{n, k, std::nullopt}, rough, ks, gain});
                }};
    }
    /// Of solid glass: what is reflected and what goes in, each in its colour.
    Reflection solid(TextureId reflected, TextureId transmitted, float eta, const Roughness& rough) {
        return {std::max(most_of(reflected), most_of(transmitted)), true,
                [this, reflected, transmitted, eta, rough](float gain) {
                    return made(DielectricMaterial{eta, rough, textures_.scaled(reflected, gain),
                                                   textures_.scaled(transmitted, gain)});
                }};
    }

    Parameters& parameters_;
    const OlderSources& sources_;
    Textures& textures_;
    std::optional<TextureId> bump_;
};

}  // namespace lightnet::pbrt
