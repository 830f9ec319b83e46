// Inputs of a material at one place of a surface, and what it may say of itself.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "core/base/index_of.hpp"
#include "core/base/math/rgb.hpp"
#include "core/scene/bsdf/roughness.hpp"
#include "core/scene/textures/look_up.hpp"

namespace lightnet {

class Coat;
class CoatedMetal;

struct Material;
/// Into SceneData::materials.
using MaterialId = IndexOf<Material>;

/// Where the light goes that a surface lets through.
enum class Transparency {
    opaque,  // there is none
    sheet,   // to the other side of a sheet, and so out again
    solid,   // into a body, which may absorb it
};

/// What coated materials have worked out once: see Coats. Lives as long as the scene.
struct Coating {
    const Coat* coat = nullptr;
    const CoatedMetal* over_metal = nullptr;
};

/// No part of it above 1.
inline Rgb limited(Rgb c) { return {std::min(1.0f, c.r), std::min(1.0f, c.g), std::min(1.0f, c.b)}; }

/// The textures of a material, evaluated at one place. A value: make it, use it, drop it.
class MaterialInputs {
public:
    MaterialInputs(std::span<const Texture> textures, const TexturePlace& place, const Coating& coating = {})
        : textures_(textures), place_(place), coating_(coating) {}

    Rgb colour(TextureId texture) const { return look_up(textures_, texture, place_); }
    /// A colour of which no part exceeds 1.
    Rgb albedo(TextureId texture) const { return limited(colour(texture)); }
    /// White where there is no texture.
    Rgb tint(std::optional<TextureId> texture) const { return texture ? albedo(*texture) : Rgb{1, 1, 1}; }
    /// A number, times the red of its texture.
    float times(float value, std::optional<TextureId> texture) const {
        return texture ? value * colour(*texture).r : value;
    }
    /// A number, times the red of its texture, within 0 … 1.
    float share(float value, std::optional<TextureId> texture) const {
        return std::clamp(times(value, texture), 0.0f, 1.0f);
    }
    Microfacets facets(const Roughness& roughness) const { return facets_of(roughness, times(1, roughness.texture)); }
    /// That which the material made by its coating().
    const Coating& coating() const { return coating_; }

private:
    std::span<const Texture> textures_;
    TexturePlace place_;
    Coating coating_;
};

}  // namespace lightnet
