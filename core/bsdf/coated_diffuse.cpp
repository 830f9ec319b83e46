#include "core/bsdf/coated_diffuse.hpp"

#include "core/bsdf/fresnel.hpp"

namespace lightnet {
namespace {

// Directional albedo of rough reflection, by a fixed grid over the visible normals.
float rough_reflectance(const Ggx& facets, float eta, float cosine) {
    constexpr int steps = 48;
    const Vec3 w{std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine};
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const Vec3 m = facets.sample_visible(w, {(float(i) + 0.5f) / steps, (float(j) + 0.5f) / steps});
            const Vec3 out = reflect(w, m);
            if (out.z <= 0) continue;
            sum += fresnel_dielectric(dot(w, m), eta) * facets.visible(w, out) / facets.visible(w);
        }
    return float(sum / (steps * steps));
}

}  // namespace

Coat::Coat(float eta, float alpha_u, float alpha_v) : eta_(eta), facets_{alpha_u, alpha_v} {
    if (!smooth()) {
        facets_.alpha_u = std::max(alpha_u, specular_alpha);
        facets_.alpha_v = std::max(alpha_v, specular_alpha);
        for (std::size_t i = 0; i <= steps; ++i)
            table_[i] = rough_reflectance(facets_, eta, std::max(1e-3f, float(i) / steps));
    }
    constexpr int strips = 1024;
    double outer = 0;  // share of diffuse light from outside that is reflected
    for (int i = 0; i < strips; ++i) {
        const float cosine = (float(i) + 0.5f) / strips;
        outer += 2 * cosine * reflectance(cosine) / strips;
    }
    inner_ = float(1 - (1 - outer) / (double{eta} * eta));  // radiance squeezed into a smaller cone below
}

float Coat::reflectance(float cosine) const {
    if (smooth()) return fresnel_dielectric(cosine, eta_);
    const float at = std::clamp(cosine, 0.0f, 1.0f) * steps;
    const auto low = std::min(static_cast<std::size_t>(at), steps - 1);
    const float share = at - float(low);
    return table_[low] * (1 - share) + table_[low + 1] * share;
}

// With which probability the coat is sampled, not the base.
float CoatedDiffuseBsdf::coat_chance(float reflectance, std::uint8_t lobes) const {
    if (!(lobes & lobe::diffuse)) return 1;
    if (!(lobes & coat_lobe())) return 0;
    const float base = (1 - reflectance) * max_component(albedo);
    return reflectance > 0 ? reflectance / (reflectance + base) : 0;
}

Rgb CoatedDiffuseBsdf::base_value(float reflectance, Vec3 incoming) const {
    const float inner = coat->inner_reflectance();
    const float enters = (1 - reflectance) * (1 - coat->reflectance(incoming.z)) / (coat->eta() * coat->eta());
    const Rgb series{albedo.r / (1 - albedo.r * inner), albedo.g / (1 - albedo.g * inner),
                     albedo.b / (1 - albedo.b * inner)};
    return series * (enters * incoming.z * inverse_pi);
}

BsdfValue CoatedDiffuseBsdf::coat_value(Vec3 outgoing, Vec3 incoming) const {
    const Ggx& facets = coat->facets();
    const Vec3 m = normalize(outgoing + incoming);
    const float cosine = dot(outgoing, m);
    if (cosine <= 0) return {};
    const float both = facets.density(m) / (4 * outgoing.z);
    const float value = both * facets.visible(outgoing, incoming) * fresnel_dielectric(cosine, coat->eta());
    return {{value, value, value}, both * facets.visible(outgoing)};
}

BsdfValue CoatedDiffuseBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (incoming.z <= 0 || !(lobes & lobe::rough & this->lobes())) return {};
    const float reflectance = coat->reflectance(outgoing.z);
    const float chance = coat_chance(reflectance, lobes);
    BsdfValue sum;
    if (lobes & lobe::diffuse) {
        sum.value += base_value(reflectance, incoming);
        sum.pdf += (1 - chance) * incoming.z * inverse_pi;
    }
    if ((lobes & lobe::glossy) && !coat->smooth()) {
        const auto [value, pdf] = coat_value(outgoing, incoming);
        sum.value += value;
        sum.pdf += chance * pdf;
    }
    return sum;
}

std::optional<BsdfSample> CoatedDiffuseBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes())) return {};
    const float reflectance = coat->reflectance(outgoing.z);
    const float chance = coat_chance(reflectance, lobes);
    if (choice < chance && coat->smooth()) {
        const float weight = reflectance / chance;
        return BsdfSample{{-outgoing.x, -outgoing.y, outgoing.z}, {weight, weight, weight}, 0, lobe::specular};
    }
    const bool base = choice >= chance;
    const Vec3 incoming =
        base ? cosine_hemisphere(u) : normalize(reflect(outgoing, coat->facets().sample_visible(outgoing, u)));
    const auto [value, pdf] = evaluate(outgoing, incoming, lobes);
    if (!(pdf > 0)) return {};
    return BsdfSample{incoming, value / pdf, pdf, base ? lobe::diffuse : lobe::glossy};
}

}  // namespace lightnet
