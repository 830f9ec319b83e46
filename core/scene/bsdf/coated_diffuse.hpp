// A diffuse base under a dielectric coat: plastic, varnish, glazed clay.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/coat.hpp"
#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/scattering.hpp"
#include "core/scene/bsdf/seen.hpp"

namespace lightnet {

/// What pbrt finds by random walks between the layers: light is reflected by the coat, or enters it, is scattered by
/// the base, partly sent back down by the coat any number of times (a geometric series), and leaves. Since the base
/// forgets where light came from the sum is exact for smooth and for rough coats. A white base under a smooth coat that
/// absorbs nothing reflects everything; rough coats lose what single scattering loses.
struct CoatedDiffuseBsdf {
    static constexpr bool two_sided = true;
    static constexpr bool chooses = true;
    Rgb albedo;                  // of the base
    const Coat* coat = nullptr;  // lives as long as the scene
    Microfacets facets{};        // of the coat
    Rgb tint{1, 1, 1};           // of the coat's reflection
    bool base_colours_repeat = true;

    bool smooth() const { return is_specular(facets.alpha_u, facets.alpha_v); }
    std::uint8_t coat_lobe() const { return smooth() ? lobe::specular : lobe::glossy; }
    std::uint8_t lobes() const { return static_cast<std::uint8_t>(coat_lobe() | lobe::diffuse); }
    /// With which probability the coat is sampled, not the base, where it reflects that share.
    float coat_chance(float reflectance, std::uint8_t lobes) const;
    /// What all ways off the base come to, by colour: without what the coat lets in and out.
    Rgb base_reflectance() const;
    CosineChoices cosine_choices(float outgoing, std::uint8_t lobes) const;
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

/// It from one direction (see seen.hpp), its facets by one law. Lobes that were not asked for are black.
template <class Law>
struct SeenCoatedDiffuse {
    using Model = CoatedDiffuseBsdf;
    FacetsOf<Law> facets;
    Rgb base;                     // what all ways off the base come to
    Rgb tint;                     // of the coat's reflection
    float eta, reflected;         // of the coat
    float chance;                 // with which the coat is sampled
    float passed;                 // by the coat, out to the viewer
    std::uint32_t mirror, gloss;  // the coat is smooth; it is rough, and counts

    static SeenCoatedDiffuse of(const Model& model, float outgoing, std::uint8_t lobes) {
        const float reflected = model.coat->reflectance(model.facets, outgoing);
        return {model.facets.of<Law>(),
                lobes & lobe::diffuse ? model.base_reflectance() : Rgb{},
                model.tint,
                model.coat->eta(),
                reflected,
                model.coat_chance(reflected, lobes),
                model.coat->transmittance(model.facets, outgoing),
                model.smooth(),
                !model.smooth() && (lobes & lobe::glossy)};
    }
    static float arriving(const Model& model, float incoming) {
        return model.coat->transmittance(model.facets, incoming);
    }
    // Radiance shrinks by η² on its way out.
    template <bool many>
    [[gnu::always_inline]] BsdfValue value(Vec3 outgoing, Vec3 incoming, float passed_in) const {
        const Rgb below = base * (passed * passed_in / (eta * eta) * incoming.z * inverse_pi);
        const float below_pdf = (1 - chance) * incoming.z * inverse_pi;
        const auto [value, pdf, cosine] = many || gloss ? reflection(facets, outgoing, incoming) : Facets{};
        const Rgb both = below + tint * (fresnel_dielectric(cosine, eta) * value);
        return {chosen(gloss, both, below), gloss ? below_pdf + chance * pdf : below_pdf};
    }
    template <bool many>
    [[gnu::always_inline]] Proposal propose(Vec3 outgoing, float choice, Vec2 u) const {
        const bool below = choice >= chance;
        const Vec3 by_base = many || below ? cosine_hemisphere(u) : Vec3{};
        const bool by_gloss = many || (!below && !mirror);
        const Vec3 by_facets = by_gloss ? reflected_by(facets, outgoing, u) : Vec3{};
        const Vec3 by_coat = chosen(mirror, Vec3{-outgoing.x, -outgoing.y, outgoing.z}, by_facets);
        const std::uint32_t coat_lobe = mirror ? lobe::specular : lobe::glossy;
        return {chosen(below, by_base, by_coat), below ? std::uint32_t{lobe::diffuse} : coat_lobe};
    }
    Rgb mirrored(float) const { return tint * (reflected / chance); }
    CosineChoices cosine_choices() const { return {chance, 1}; }
};

class Coats;

/// A diffuse base under a dielectric coat.
struct CoatedDiffuseMaterial {
    static constexpr const char* name = "coated diffuse";
    TextureId reflectance = 0;  // of the base
    float eta = 1.5f;
    Roughness roughness{};            // of the coat
    std::optional<TextureId> tint{};  // not physical, but in files: times the coat's reflection
    bool base_colours_repeat = true;  // light that goes back and forth below the coat takes the base's colour each time
    CoatLayer layer{};

    Transparency transparency() const { return Transparency::opaque; }
    Coating coating(Coats& coats) const;
    CoatedDiffuseBsdf at(const MaterialInputs& inputs) const;
};
void visit_members(Is<CoatedDiffuseMaterial> auto& material, const auto& visit) {
    auto& [reflectance, eta, roughness, tint, base_colours_repeat, layer] = material;
    visit(reflectance, eta, roughness, tint, base_colours_repeat, layer);
}

}  // namespace lightnet
