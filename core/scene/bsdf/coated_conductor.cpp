#include "core/scene/bsdf/coated_conductor.hpp"

#include <algorithm>
#include <cmath>

#include "core/scene/bsdf/coats.hpp"
#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"

namespace lightnet {

// What smooth layers send into the mirrored direction, but for the coat's own reflection.
Rgb CoatedConductorBsdf::below_smooth(Vec3 outgoing) const {
    const Rgb mirrored = metal.tint * fresnel_conductor(into_coat(outgoing, coat->eta()).z, metal.eta, metal.k);
    const float reflected = coat->reflectance(facets, outgoing.z), left = coat->left_within(outgoing.z);
    const float passes = (1 - reflected) * (1 - reflected) * left * left, again = reflected * left * left;
    const auto series = [&](float r) { return passes * coat->series(r, r * again); };
    return {series(mirrored.r), series(mirrored.g), series(mirrored.b)};
}

Rgb CoatedConductorBsdf::below_rough(Vec3 outgoing) const {
    const Rgb mirrored = metal.tint * fresnel_conductor(into_coat(outgoing, coat->eta()).z, metal.eta, metal.k);
    const auto returned = between->returned(facets, below, outgoing.z);
    return {returned.albedo(mirrored.r), returned.albedo(mirrored.g), returned.albedo(mirrored.b)};
}

float CoatedConductorBsdf::coat_chance(Vec3 outgoing, std::uint8_t lobes) const {
    const std::uint8_t own = smooth() ? lobe::specular : lobe::glossy;
    if (!(lobes & metal.lobes())) return 1;
    if (!(lobes & own)) return 0;
    const float top = coat->reflectance(facets, outgoing.z);
    const float bottom = max_component(metal.smooth() ? below_smooth(outgoing) : below_rough(outgoing));
    return top > 0 ? top / (top + bottom) : 0;
}

BsdfValue CoatedConductorBsdf::metal_value(Vec3 outgoing, Vec3 incoming) const {
    const float eta = coat->eta();
    const Vec3 o = into_coat(outgoing, eta), i = into_coat(incoming, eta);
    const auto [value, pdf, cosine] = reflection(metal.facets, o, i);
    if (!(cosine > 0)) return {};
    // solid angles grow as light leaves: cos dω outside is η² cos dω inside
    const float spread = incoming.z / (i.z * eta * eta);
    const float passes = coat->transmittance(facets, outgoing.z) * coat->transmittance(facets, incoming.z);
    const auto from = between->returned(facets, below, outgoing.z), to = between->returned(facets, below, incoming.z);
    const Rgb mirrored = metal.tint * fresnel_conductor(cosine, metal.eta, metal.k);
    const Rgb factor{from.factor_with(to, mirrored.r), from.factor_with(to, mirrored.g),
                     from.factor_with(to, mirrored.b)};
    return {factor * (passes * value * spread), pdf * spread};
}

BsdfValue CoatedConductorBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::glossy & this->lobes()) || incoming.z <= 0) return {};
    const float chance = coat_chance(outgoing, lobes);
    BsdfValue sum;
    if (!metal.smooth()) {
        const auto [value, pdf] = metal_value(outgoing, incoming);
        sum.value += value;
        sum.pdf += (1 - chance) * pdf;
    }
    if (!smooth()) {
        const auto [value, pdf, cosine] = reflection(facets, outgoing, incoming);
        const float both = fresnel_dielectric(cosine, coat->eta()) * value;
        sum.value += Rgb{both, both, both};
        sum.pdf += chance * pdf;
    }
    return sum;
}

std::optional<BsdfSample> CoatedConductorBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes())) return {};
    const float chance = coat_chance(outgoing, lobes);
    const bool top = choice < chance;
    const Vec3 mirrored{-outgoing.x, -outgoing.y, outgoing.z};
    if (top && smooth()) {
        const float weight = coat->reflectance(facets, outgoing.z) / chance;
        return BsdfSample{mirrored, {weight, weight, weight}, 0, lobe::specular};
    }
    if (!top && metal.smooth()) {
        return BsdfSample{mirrored, below_smooth(outgoing) / (1 - chance), 0, lobe::specular};
    }
    std::optional<Vec3> incoming;
    if (top) {
        incoming = normalize(reflect(outgoing, facets.sample_visible(outgoing, u)));
    } else {
        const Vec3 o = into_coat(outgoing, coat->eta()), i = normalize(reflect(o, metal.facets.sample_visible(o, u)));
        if (i.z > 0) incoming = out_of_coat(i, coat->eta());  // none: sent back down, which the factors have already
    }
    if (!incoming) return {};
    const auto [value, pdf] = evaluate(outgoing, *incoming, lobes);
    if (!(pdf > 0)) return {};
    return BsdfSample{*incoming, value / pdf, pdf, lobe::glossy};
}

Coating CoatedConductorMaterial::coating(Coats& coats) const {
    const auto above = facet_range_of(coat), below = facet_range_of(roughness);
    const Coat& one = coats.coat(coat_eta, above, layer);
    return {&one, coats.over_metal(one, above, below)};
}

CoatedConductorBsdf CoatedConductorMaterial::at(const MaterialInputs& inputs) const {
    const Microfacets above = inputs.facets(coat), below = inputs.facets(roughness);
    ConductorBsdf under = metal.at(inputs, seen_through(below, above, coat_eta));
    under.eta = under.eta / coat_eta;
    under.k = under.k / coat_eta;
    return {under, inputs.coating().coat, above, inputs.coating().over_metal, below};
}

}  // namespace lightnet
