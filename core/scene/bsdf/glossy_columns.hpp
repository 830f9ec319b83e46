// Models with gloss as a structure of arrays: the formulas of one point alone, for loops over many.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/math/columns.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/coated_diffuse.hpp"
#include "core/scene/bsdf/conductor.hpp"
#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/ggx.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// Facets of many surfaces, by the GGX law.
struct FacetColumns {
    Column alpha_u, alpha_v;
    Flags by_height;

    void set(std::size_t i, const Microfacets& facets) {
        alpha_u[i] = facets.alpha_u;
        alpha_v[i] = facets.alpha_v;
        by_height[i] = facets.law.masking == FacetLaw::Masking::by_height;
    }
    FacetsOf<GgxLaw> at(std::size_t i) const { return {alpha_u[i], alpha_v[i], by_height[i] != 0}; }
    /// Where facets that are seen from `outgoing` reflect it to.
    [[gnu::always_inline]] Vec3 reflected(std::size_t i, Vec3 outgoing, Vec2 u) const {
        return normalize(reflect(outgoing, at(i).sample_visible(outgoing, u)));
    }
};

/// What a model proposes: a direction above the surface, if its z is above 0.
struct Proposal {
    Vec3 incoming;
    std::uint32_t lobe;
};

// Models of many points. All directions are local, z > 0. Before anything else see() tells from where a point is seen
// and which lobes count (all rough ones that the model has, at least), and before value() arrive() from where light comes: they
// look into tables, and so are no part of loops.

/// As CoatedDiffuseBsdf has it.
struct CoatedColumns {
    using Model = CoatedDiffuseBsdf;

    void set(std::size_t i, const Model& model) { models_[i] = model; }
    const Model& model(std::size_t i) const { return models_[i]; }
    bool has_gloss(std::size_t i) const { return !smooth_[i]; }
    void see(std::size_t i, float outgoing, std::uint8_t lobes) {
        const Model& model = models_[i];
        const Rgb base = model.base_reflectance();
        facets_.set(i, model.facets);
        base_.set(i, {base.r, base.g, base.b});
        tint_.set(i, {model.tint.r, model.tint.g, model.tint.b});
        eta_[i] = model.coat->eta();
        smooth_[i] = model.smooth();
        reflected_[i] = model.coat->reflectance(model.facets, outgoing);
        chance_[i] = model.coat_chance(reflected_[i], lobes);
        passed_out_[i] = model.coat->transmittance(model.facets, outgoing);
    }
    void arrive(std::size_t i, float incoming) {
        passed_in_[i] = models_[i].coat->transmittance(models_[i].facets, incoming);
    }
    [[gnu::always_inline]] BsdfValue value(std::size_t i, Vec3 outgoing, Vec3 incoming) const {
        const Rgb reflectance{base_.x[i], base_.y[i], base_.z[i]}, tint{tint_.x[i], tint_.y[i], tint_.z[i]};
        const float eta = eta_[i], chance = chance_[i];
        const Rgb base = coated_base(reflectance, passed_out_[i] * passed_in_[i] / (eta * eta), incoming.z);
        const float base_pdf = (1 - chance) * incoming.z * inverse_pi;
        const auto [value, pdf, cosine] = reflection(facets_.at(i), outgoing, incoming);
        const Rgb both = base + tint * (fresnel_dielectric(cosine, eta) * value);
        const bool smooth = smooth_[i] != 0;
        return {{smooth ? base.r : both.r, smooth ? base.g : both.g, smooth ? base.b : both.b},
                smooth ? base_pdf : base_pdf + chance * pdf};
    }
    [[gnu::always_inline]] Proposal propose(std::size_t i, Vec3 outgoing, float choice, Vec2 u) const {
        const Vec3 by_base = cosine_hemisphere(u), by_facets = facets_.reflected(i, outgoing, u);
        const bool base = choice >= chance_[i], smooth = smooth_[i] != 0;
        const Vec3 by_coat{smooth ? -outgoing.x : by_facets.x, smooth ? -outgoing.y : by_facets.y,
                           smooth ? outgoing.z : by_facets.z};
        const std::uint32_t coat_lobe = smooth ? lobe::specular : lobe::glossy;
        return {{base ? by_base.x : by_coat.x, base ? by_base.y : by_coat.y, base ? by_base.z : by_coat.z},
                base ? lobe::diffuse : coat_lobe};
    }
    /// Of a smooth coat that was chosen.
    Rgb specular_weight(std::size_t i) const {
        return Rgb{tint_.x[i], tint_.y[i], tint_.z[i]} * (reflected_[i] / chance_[i]);
    }

private:
    std::array<Model, lanes> models_;
    FacetColumns facets_;
    Columns3 base_, tint_;
    Column eta_, reflected_, chance_, passed_out_, passed_in_;
    Flags smooth_;
};

/// As ConductorBsdf has it, where it is not smooth.
struct MetalColumns {
    using Model = ConductorBsdf;

    void set(std::size_t i, const Model& model) { models_[i] = model; }
    const Model& model(std::size_t i) const { return models_[i]; }
    bool has_gloss(std::size_t) const { return true; }
    void see(std::size_t i, float, std::uint8_t) {
        const Model& model = models_[i];
        facets_.set(i, model.facets);
        eta_.set(i, {model.eta.r, model.eta.g, model.eta.b});
        k_.set(i, {model.k.r, model.k.g, model.k.b});
        tint_.set(i, {model.tint.r, model.tint.g, model.tint.b});
    }
    void arrive(std::size_t, float) const {}
    [[gnu::always_inline]] BsdfValue value(std::size_t i, Vec3 outgoing, Vec3 incoming) const {
        const auto [value, pdf, cosine] = reflection(facets_.at(i), outgoing, incoming);
        const Rgb tint{tint_.x[i], tint_.y[i], tint_.z[i]};
        const Rgb reflected{fresnel_conductor(cosine, eta_.x[i], k_.x[i]),
                            fresnel_conductor(cosine, eta_.y[i], k_.y[i]),
                            fresnel_conductor(cosine, eta_.z[i], k_.z[i])};
        return {tint * reflected * value, pdf};
    }
    [[gnu::always_inline]] Proposal propose(std::size_t i, Vec3 outgoing, float, Vec2 u) const {
        return {facets_.reflected(i, outgoing, u), lobe::glossy};
    }
    Rgb specular_weight(std::size_t) const { return {}; }

private:
    std::array<Model, lanes> models_;
    FacetColumns facets_;
    Columns3 eta_, k_, tint_;
};

}  // namespace lightnet
