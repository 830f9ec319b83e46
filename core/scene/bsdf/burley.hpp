// Disney's principled material as Mitsuba renders it, whose parts add up: Burley 2012, "Physically Based Shading at
// Disney", and 2015, "Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering".
#pragma once

#include <optional>

#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/microfacets.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// Its parts know nothing of each other, so that together they may give more than they got where a bright base meets
/// grazing light: so does Mitsuba, and pictures of its scenes must agree with it.
/// DECISIONS: burley-adds-up
struct BurleyBsdf {
    static constexpr bool two_sided = false;  // but for solids that let light through, it is made so
    static constexpr bool chooses = true;
    /// Clear coat: facets by the law GTR1.
    struct Coat {
        float strength = 0, alpha = 0.1f;

        float density(float height) const;
        Vec3 sample(Vec2 u) const;
        float value(Vec3 outgoing, Vec3 incoming, Vec3 facet) const;
    };
    /// What is reflected as if diffusely.
    struct Matt {
        float roughness = 0.5f, flatness = 0, sheen = 0, sheen_tint = 0;
        float through = 0;  // of a sheet: share that goes to its other side
    };
    Rgb base;
    float metallic = 0, transmission = 0, tint = 0;  // the latter: of reflections, towards the base
    Microfacets facets{}, window{};                  // window: what light meets that passes a sheet
    float eta = 1.5f;                                // inside over outside, at least 1
    Matt matt{};
    Coat coat{};
    bool thin = false;  // a sheet; metallic and coat are 0 then

    bool smooth() const { return is_specular(facets.alpha_u, facets.alpha_v); }
    /// Does some light get to the other side?
    bool lets_through() const { return transmission > 0 || matt.through > 0; }
    std::uint8_t lobes() const;
    CosineChoices cosine_choices(float outgoing, std::uint8_t lobes) const;
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;

private:
    /// With which probability each part is sampled.
    struct Chances {
        float coat = 0, matt = 0, through = 0, facets = 0;
    };
    Chances chances(float height, std::uint8_t lobes) const;
    bool turned(Vec3 outgoing) const { return outgoing.z < 0 && (thin || transmission == 0); }
    std::uint8_t facet_lobe() const { return smooth() ? lobe::specular : lobe::glossy; }
    float matt_share() const { return (1 - metallic) * (1 - transmission); }
    float glass_share() const { return (1 - metallic) * transmission; }
    Rgb hue() const;
    Rgb reflectance(float cosine) const;
    Rgb transmittance(float cosine) const;
    float reflection_chance(float facet, float height) const;
    Rgb matt_value(Vec3 o, Vec3 i) const;
    void add_facets(Vec3 o, Vec3 i, float chance, BsdfValue& sum) const;
    BsdfValue upright_value(Vec3 o, Vec3 i, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample_smooth(Vec3 o, float choice, float chance) const;
    std::optional<BsdfSample> sample_facets(Vec3 o, float choice, Vec2 u) const;
    std::optional<BsdfSample> upright_sample(Vec3 o, float choice, Vec2 u, std::uint8_t lobes) const;
};

/// All numbers are 0 … 1 where nothing else is said; the red of their textures counts.
struct BurleyMaterial {
    static constexpr const char* name = "burley";
    TextureId base_colour = 0, metallic = 0, transmission = 0, tint = 0;
    Roughness roughness{0.5f, 0.5f, {}, Roughness::Means::square};
    TextureId eta = 0;  // at least 1
    TextureId flatness = 0, sheen = 0, sheen_tint = 0;
    TextureId coat = 0, gloss = 0;  // the latter: of the coat
    TextureId through = 0;          // of what a sheet scatters, what goes to its other side
    bool thin = false, lets_through = false;
    std::optional<TextureId> specular{};     // tells eta; none: `eta` does
    std::optional<TextureId> anisotropic{};  // stretches `roughness` along u, beside what that says itself

    Transparency transparency() const {
        if (!lets_through) return Transparency::opaque;
        return thin ? Transparency::sheet : Transparency::solid;
    }
    BurleyBsdf at(const MaterialInputs& inputs) const;
};
void visit_members(Is<BurleyMaterial> auto& material, const auto& visit) {
    auto& [base_colour, metallic, transmission, tint, roughness, eta, flatness, sheen, sheen_tint, coat, gloss, through,
           thin, lets_through, specular, anisotropic] = material;
    visit(base_colour, metallic, transmission, tint, roughness, eta, flatness, sheen, sheen_tint, coat, gloss, through,
          thin, lets_through, specular, anisotropic);
}

/// What a reflection of that strength (0 … 1) is that of, head-on. Burley 2015, section 3.
float eta_of_specular(float specular);
/// By how much α is larger along u, and smaller along v, as square roots. Burley 2012, section 5.4.
float stretch_of(float anisotropic);

}  // namespace lightnet
