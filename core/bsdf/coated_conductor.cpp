#include "core/bsdf/coated_conductor.hpp"

#include <algorithm>
#include <cmath>

#include "core/bsdf/fresnel.hpp"
#include "core/bsdf/microfacets.hpp"

namespace lightnet {

// A facet's slope s turns what it reflects by 2 s, and what it refracts by (1 - 1/η) s; light passes the coat twice.
Ggx CoatedConductorBsdf::seen_through(const Ggx& metal, const Ggx& coat, float eta) {
    const float turn = (1 - 1 / eta) / 2;
    const auto blurred = [&](float below, float above) {
        return std::sqrt(below * below + 2 * turn * turn * above * above);
    };
    const Ggx both{blurred(metal.alpha_u, coat.alpha_u), blurred(metal.alpha_v, coat.alpha_v)};
    if (is_specular(both.alpha_u, both.alpha_v)) return {};
    return {std::max(both.alpha_u, specular_alpha), std::max(both.alpha_v, specular_alpha)};
}

// The direction within the coat that belongs to one above it; both lie above the metal.
Vec3 CoatedConductorBsdf::inwards(Vec3 w) const {
    const float scale = 1 / coat->eta();
    return {w.x * scale, w.y * scale, std::sqrt(std::max(1e-8f, 1 - (w.x * w.x + w.y * w.y) * scale * scale))};
}

std::optional<Vec3> CoatedConductorBsdf::outwards(Vec3 w) const {
    const float x = w.x * coat->eta(), y = w.y * coat->eta(), z2 = 1 - x * x - y * y;
    if (!(z2 > 0)) return {};
    return Vec3{x, y, std::sqrt(z2)};
}

// What both layers let through and reflect, for light that is neither coat's nor metal's alone. The smaller of the two
// reflectances makes the series symmetric, and never gives more than was let in. `left` by absorption, down and up.
Rgb CoatedConductorBsdf::through(float cosine, float reflected_o, float reflected_i, float left) const {
    const Rgb below = metal.tint * fresnel_conductor(cosine, metal.eta, metal.k);
    const float again = std::min(reflected_o, reflected_i) * left,
                passes = (1 - reflected_o) * (1 - reflected_i) * left;
    const auto series = [&](float r) { return passes * coat->series(r, r * again); };
    return {series(below.r), series(below.g), series(below.b)};
}

float CoatedConductorBsdf::coat_chance(Vec3 outgoing, std::uint8_t lobes) const {
    const std::uint8_t own = smooth() ? lobe::specular : lobe::glossy;
    if (!(lobes & metal.lobes())) return 1;
    if (!(lobes & own)) return 0;
    const float top = coat->reflectance(facets, outgoing.z);
    const float below = max_component(through(inwards(outgoing).z, top, top, 1));
    return top > 0 ? top / (top + below) : 0;
}

BsdfValue CoatedConductorBsdf::metal_value(Vec3 outgoing, Vec3 incoming) const {
    const Vec3 o = inwards(outgoing), i = inwards(incoming);
    const auto [value, pdf, cosine] = reflection(metal.facets, o, i);
    if (!(cosine > 0)) return {};
    // solid angles grow as light leaves: cos dω outside is η² cos dω inside
    const float spread = incoming.z / (i.z * coat->eta() * coat->eta());
    const float reflected_o = coat->reflectance(facets, outgoing.z),
                reflected_i = coat->reflectance(facets, incoming.z);
    const float left = coat->left_within(outgoing.z) * coat->left_within(incoming.z);
    return {through(cosine, reflected_o, reflected_i, left) * (value * spread), pdf * spread};
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
    const float reflected = coat->reflectance(facets, outgoing.z);
    if (top && smooth()) {
        const float weight = reflected / chance;
        return BsdfSample{mirrored, {weight, weight, weight}, 0, lobe::specular};
    }
    if (!top && metal.smooth()) {
        const float left = coat->left_within(outgoing.z);
        const Rgb weight = through(inwards(outgoing).z, reflected, reflected, left * left) / (1 - chance);
        return BsdfSample{mirrored, weight, 0, lobe::specular};
    }
    std::optional<Vec3> incoming;
    if (top) {
        incoming = normalize(reflect(outgoing, facets.sample_visible(outgoing, u)));
    } else {
        const Vec3 o = inwards(outgoing), i = normalize(reflect(o, metal.facets.sample_visible(o, u)));
        if (i.z > 0) incoming = outwards(i);  // none: sent back down, which the series has already
    }
    if (!incoming) return {};
    const auto [value, pdf] = evaluate(outgoing, *incoming, lobes);
    if (!(pdf > 0)) return {};
    return BsdfSample{*incoming, value / pdf, pdf, lobe::glossy};
}

}  // namespace lightnet
