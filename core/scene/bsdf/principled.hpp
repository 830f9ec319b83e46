// The material of game engines and film studios: metal, plastic, glass and cloth by a few numbers.
#pragma once

#include <optional>

#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/microfacets.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// glTF 2.0's metallic-roughness model (appendix B of its specification) with the extensions specular, ior,
/// transmission, volume, sheen and clearcoat. Its mixes and layers are those of the specification; where that shares
/// light between layers by a rule which can give more than it got, or depends on the order of the two directions, a
/// symmetric one by directional albedos stands here: never above 1, and reciprocal.
struct PrincipledBsdf {
    static constexpr bool two_sided = false;  // but for solids that let light through, it is made so
    static constexpr bool chooses = true;
    Rgb base;
    float metallic = 0, transmission = 0;
    Microfacets facets{};
    float eta = 1.5f;  // inside over outside
    Rgb f0;            // of the dielectric's reflection, head-on
    float f90 = 1;     // and at grazing angles
    Rgb sheen;
    float sheen_alpha = 0.1f;
    float coat = 0, coat_alpha = 0;
    bool thin = true;

    bool smooth() const { return is_specular(facets.alpha_u, facets.alpha_v); }
    bool smooth_coat() const { return is_specular(coat_alpha, coat_alpha); }
    std::uint8_t lobes() const;
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;

private:
    struct Chances {
        float coat = 0, sheen = 0, diffuse = 0, facets = 0;
    };
    /// Of the layers above the base: how much of the light to and from the base they leave.
    struct Layers {
        float below_coat = 1, below_sheen = 1;
    };
    bool turned(Vec3 outgoing) const { return outgoing.z < 0 && (thin || transmission == 0); }
    float alpha() const;
    float plastic_share() const { return (1 - metallic) * (1 - transmission); }
    float glass_share() const { return (1 - metallic) * transmission; }
    Rgb glass_tint() const;
    float glass_reflectance(float cosine) const;
    Rgb reflectance(float cosine) const;
    Rgb transmittance(float cosine) const;
    float reflection_chance(float cosine) const;
    float plastic_albedo(float cosine) const;
    Layers layers(Vec3 outgoing, Vec3 incoming) const;
    Chances chances(Vec3 outgoing, std::uint8_t lobes) const;
    void add_diffuse(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances, BsdfValue& sum) const;
    void add_glossy(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances, BsdfValue& sum) const;
    BsdfValue upright_value(Vec3 o, Vec3 i, std::uint8_t lobes) const;
    std::optional<BsdfSample> upright_sample(Vec3 o, float choice, Vec2 u, std::uint8_t lobes) const;
    std::optional<BsdfSample> mirror(Vec3 o, const Rgb& value, float chance) const;
    std::optional<BsdfSample> window(Vec3 o, float chance) const;
    std::optional<BsdfSample> sample_smooth(Vec3 o, float choice, float chance) const;
    std::optional<BsdfSample> sample_facets(Vec3 o, float choice, Vec2 u) const;
};

/// The principled model of Burley (2012, 2015), of which glTF's metallic-roughness model with its extensions is a part.
/// Numbers are 0 … 1 where nothing else is said; a texture multiplies.
struct PrincipledMaterial {
    static constexpr const char* name = "principled";
    TextureId base_colour = 0;
    float metallic = 0, transmission = 0;
    std::optional<TextureId> metallic_texture{}, transmission_texture{};
    Roughness roughness{0.5f, 0.5f, {}, Roughness::Means::square};
    float eta = 1.5f;
    float specular = 1;            // times the dielectric reflection
    Rgb specular_colour{1, 1, 1};  // of it, head-on; may exceed 1
    std::optional<TextureId> specular_texture{}, specular_colour_texture{};
    float sheen = 0, sheen_roughness = 0.3f;
    Rgb sheen_colour{1, 1, 1};
    std::optional<TextureId> sheen_texture{}, sheen_roughness_texture{};  // the first has colours
    float clearcoat = 0;
    std::optional<TextureId> clearcoat_texture{};
    Roughness clearcoat_roughness{0.03f, 0.03f, {}, Roughness::Means::square};
    bool thin = true;  // of transmission: a pane rather than a solid

    Transparency transparency() const {
        if (!(transmission > 0)) return Transparency::opaque;
        return thin ? Transparency::sheet : Transparency::solid;
    }
    PrincipledBsdf at(const MaterialInputs& inputs) const;
};
void visit_members(Is<PrincipledMaterial> auto& material, const auto& visit) {
    auto& [base_colour, metallic, transmission, metallic_texture, transmission_texture, roughness, eta, specular,
           specular_colour, specular_texture, specular_colour_texture, sheen, sheen_roughness, sheen_colour,
           sheen_texture, sheen_roughness_texture, clearcoat, clearcoat_texture, clearcoat_roughness, thin] = material;
    visit(base_colour, metallic, transmission, metallic_texture, transmission_texture, roughness, eta, specular,
          specular_colour, specular_texture, specular_colour_texture, sheen, sheen_roughness, sheen_colour,
          sheen_texture, sheen_roughness_texture, clearcoat, clearcoat_texture, clearcoat_roughness, thin);
}

}  // namespace lightnet
