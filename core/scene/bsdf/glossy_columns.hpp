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
#include "core/scene/bsdf/principled.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// Facets of many surfaces, all by one law.
template <class Law>
struct FacetColumns {
    Column alpha_u, alpha_v;
    Flags by_height;

    void set(std::size_t i, const Microfacets& facets) {
        alpha_u[i] = facets.alpha_u;
        alpha_v[i] = facets.alpha_v;
        by_height[i] = facets.law.masking == FacetLaw::Masking::by_height;
    }
    FacetsOf<Law> at(std::size_t i) const { return {alpha_u[i], alpha_v[i], by_height[i] != 0}; }
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
// and which lobes count (all rough ones that the model has, at least), and before value() arrive() from where light
// comes: they look into tables, and so are no part of loops.

/// As CoatedDiffuseBsdf has it.
template <class Law>
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
    CosineChoices cosine_choices(std::size_t i) const { return {chance_[i], 1}; }
    /// Of a smooth coat that was chosen.
    Rgb specular_weight(std::size_t i) const {
        return Rgb{tint_.x[i], tint_.y[i], tint_.z[i]} * (reflected_[i] / chance_[i]);
    }

private:
    std::array<Model, lanes> models_;
    FacetColumns<Law> facets_;
    Columns3 base_, tint_;
    Column eta_, reflected_, chance_, passed_out_, passed_in_;
    Flags smooth_;
};

/// As ConductorBsdf has it, where it is not smooth.
template <class Law>
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
    CosineChoices cosine_choices(std::size_t) const { return {}; }
    Rgb specular_weight(std::size_t) const { return {}; }

private:
    std::array<Model, lanes> models_;
    FacetColumns<Law> facets_;
    Columns3 eta_, k_, tint_;
};

/// As PrincipledBsdf has it, where it is opaque, without cloth, and equally rough along both tangents.
struct PrincipledColumns {
    using Model = PrincipledBsdf;

    void set(std::size_t i, const Model& model) { models_[i] = model; }
    const Model& model(std::size_t i) const { return models_[i]; }
    bool has_gloss(std::size_t i) const { return models_[i].lobes() & lobe::glossy; }
    void see(std::size_t i, float outgoing, std::uint8_t lobes) {
        const Model& model = models_[i];
        const auto chances = model.chances(outgoing, lobes);
        set_numbers(i, model);
        by_coat_[i] = chances.coat;
        by_base_[i] = chances.diffuse;
        by_facets_[i] = chances.facets;
        left_out_[i] = model.layers(outgoing).below_coat;
        passes_out_[i] = plastic_[i] > 0 ? model.passes(outgoing) : 0;
        height_[i] = outgoing;
        has_facets_[i] = chances.facets > 0;
        mirror_[i] = model.smooth() && chances.facets > 0;
    }
    void arrive(std::size_t i, float incoming) {
        const Model& model = models_[i];
        left_in_[i] = model.coat > 0 ? model.layers(incoming).below_coat : 1;
        passes_in_[i] = plastic_[i] > 0 ? model.passes(incoming) : 0;
    }
    [[gnu::always_inline]] BsdfValue value(std::size_t i, Vec3 outgoing, Vec3 incoming) const {
        const float left = left_out_[i] < left_in_[i] ? left_out_[i] : left_in_[i];
        const Rgb base = principled_base(colour(i), plastic_[i] * left, passes_out_[i], passes_in_[i],
                                         passes_on_average_[i], incoming.z);
        const float base_pdf = by_base_[i] * (incoming.z * inverse_pi);
        const auto [value, pdf, cosine] = reflection(facets_.at(i), outgoing, incoming);
        const Rgb mirror = reflected(i, cosine) * (value * left);
        const bool rough = smooth_[i] == 0, coated = rough_coat_[i] != 0;
        const auto [coat, coat_pdf, coat_cosine] = reflection(coat_facets_.at(i), outgoing, incoming);
        const float above = principled_coat(coat_[i], coat_cosine) * coat;
        const auto sum = [&](float below, float by_facets) {
            const float both = below + (rough ? by_facets : 0);
            return both + (coated ? above : 0);
        };
        const float own_pdf = by_facets_[i] * pdf, both_pdf = base_pdf + (rough ? own_pdf : 0);
        return {{sum(base.r, mirror.r), sum(base.g, mirror.g), sum(base.b, mirror.b)},
                both_pdf + (coated ? by_coat_[i] * coat_pdf : 0)};
    }
    [[gnu::always_inline]] Proposal propose(std::size_t i, Vec3 outgoing, float choice, Vec2 u) {
        const bool coat = choice < by_coat_[i], base = choice - by_coat_[i] < by_base_[i];
        const float own = facets_.alpha_u[i], above = coat_facets_.alpha_u[i], alpha = coat ? above : own;
        const std::uint32_t own_mirror = mirror_[i], coat_mirror = coat_mirror_[i];
        const bool mirror = (coat ? coat_mirror : own_mirror) != 0;
        const Vec3 by_base = cosine_hemisphere(u);
        const Vec3 by_facets = normalize(reflect(outgoing, FacetsOf<GgxLaw>{alpha, alpha}.sample_visible(outgoing, u)));
        const Vec3 gloss{mirror ? -outgoing.x : by_facets.x, mirror ? -outgoing.y : by_facets.y,
                         mirror ? outgoing.z : by_facets.z};
        const Vec3 below{base ? by_base.x : gloss.x, base ? by_base.y : gloss.y,
                         base ? by_base.z : gloss.z * has_facets_[i]};
        const std::uint32_t gloss_lobe = mirror ? lobe::specular : lobe::glossy;
        const std::uint32_t below_lobe = base ? std::uint32_t{lobe::diffuse} : gloss_lobe;
        chose_coat_[i] = coat;
        return {{coat ? gloss.x : below.x, coat ? gloss.y : below.y, coat ? gloss.z : below.z},
                coat ? gloss_lobe : below_lobe};
    }
    CosineChoices cosine_choices(std::size_t i) const { return {by_coat_[i], by_coat_[i] + by_base_[i]}; }
    /// Of a mirror that was chosen.
    Rgb specular_weight(std::size_t i) const {
        const float above = principled_coat(coat_[i], height_[i]) / by_coat_[i];
        const Rgb own = reflected(i, height_[i]) * left_out_[i] / by_facets_[i];
        const bool coat = chose_coat_[i] != 0;
        return {coat ? above : own.r, coat ? above : own.g, coat ? above : own.b};
    }

private:
    void set_numbers(std::size_t i, const Model& model) {
        facets_.set(i, model.facets);
        coat_facets_.set(i, {model.coat_alpha, model.coat_alpha});
        base_.set(i, {model.base.r, model.base.g, model.base.b});
        f0_.set(i, {model.f0.r, model.f0.g, model.f0.b});
        f90_[i] = model.f90;
        metallic_[i] = model.metallic;
        plastic_[i] = model.plastic_share();
        coat_[i] = model.coat;
        smooth_[i] = model.smooth();
        coat_mirror_[i] = model.smooth_coat();
        rough_coat_[i] = model.coat > 0 && !model.smooth_coat();
        passes_on_average_[i] = model.passes_on_average();
    }
    [[gnu::always_inline]] Rgb colour(std::size_t i) const { return {base_.x[i], base_.y[i], base_.z[i]}; }
    [[gnu::always_inline]] Rgb reflected(std::size_t i, float cosine) const {
        return principled_mirror(colour(i), metallic_[i], {f0_.x[i], f0_.y[i], f0_.z[i]}, f90_[i], plastic_[i], cosine);
    }

    std::array<Model, lanes> models_;
    FacetColumns<GgxLaw> facets_, coat_facets_;
    Columns3 base_, f0_;
    Column f90_, metallic_, plastic_, coat_;
    Column by_coat_, by_base_, by_facets_;  // chances
    Column left_out_, left_in_;             // by the coat
    Column passes_out_, passes_in_, passes_on_average_;
    Column height_;      // of the outgoing direction
    Column has_facets_;  // 1: their chance is above 0; else 0
    Flags smooth_, mirror_, rough_coat_, coat_mirror_, chose_coat_;
};

}  // namespace lightnet
