// Metal: a mirror, or microfacets of mirror. Single scattering: rough metals lose some energy, as in pbrt.
#pragma once

#include <cstdint>
#include <optional>

#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/microfacets.hpp"
#include "core/scene/bsdf/scattering.hpp"
#include "core/scene/bsdf/seen.hpp"

namespace lightnet {

struct ConductorBsdf {
    static constexpr bool two_sided = true;
    static constexpr bool chooses = false;
    Rgb eta, k;  // complex index of refraction
    Microfacets facets{};
    Rgb tint{1, 1, 1};

    bool smooth() const { return is_specular(facets.alpha_u, facets.alpha_v); }
    std::uint8_t lobes() const { return smooth() ? lobe::specular : lobe::glossy; }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

/// A rough one from one direction (see seen.hpp), its facets by one law.
template <class Law>
struct SeenConductor {
    using Model = ConductorBsdf;
    FacetsOf<Law> facets;
    Rgb eta, k, tint;

    static SeenConductor of(const Model& model, float, std::uint8_t) {
        return {model.facets.of<Law>(), model.eta, model.k, model.tint};
    }
    static float arriving(const Model&, float) { return 0; }
    template <bool>
    [[gnu::always_inline]] BsdfValue value(Vec3 outgoing, Vec3 incoming, float) const {
        const auto [value, pdf, cosine] = reflection(facets, outgoing, incoming);
        return {tint * fresnel_conductor(cosine, eta, k) * value, pdf};
    }
    template <bool>
    [[gnu::always_inline]] Proposal propose(Vec3 outgoing, float, Vec2 u) const {
        return {reflected_by(facets, outgoing, u), lobe::glossy};
    }
    Rgb mirrored(float) const { return {}; }
    CosineChoices cosine_choices() const { return {}; }
};

/// k of a metal of index 1 + i k that reflects `reflectance` at normal incidence, as pbrt takes it.
Rgb absorption_for(Rgb reflectance);

/// Index of refraction of a metal per colour, or how much it reflects head-on.
struct Metal {
    TextureId eta = 0, k = 0;
    std::optional<TextureId> reflectance{};  // given instead of eta and k

    ConductorBsdf at(const MaterialInputs& inputs, const Microfacets& facets) const;
};
void visit_members(Is<Metal> auto& metal, const auto& visit) {
    auto& [eta, k, reflectance] = metal;
    visit(eta, k, reflectance);
}
void visit_used(const Metal& metal, const auto& visit) {
    if (metal.reflectance)
        visit(*metal.reflectance);
    else
        visit(metal.eta, metal.k);
}

struct ConductorMaterial {
    static constexpr const char* name = "conductor";
    Metal metal{};
    Roughness roughness{};
    std::optional<TextureId> tint{};  // times this
    float strength = 1;               // and this; above 1 for a small share of a mixture only

    Transparency transparency() const { return Transparency::opaque; }
    ConductorBsdf at(const MaterialInputs& inputs) const;
};
void visit_members(Is<ConductorMaterial> auto& material, const auto& visit) {
    auto& [metal, roughness, tint, strength] = material;
    visit(metal, roughness, tint, strength);
}

}  // namespace lightnet
