#include "core/scene/bsdf/coated_diffuse.hpp"

#include "core/scene/bsdf/coats.hpp"
#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"

namespace lightnet {

float CoatedDiffuseBsdf::coat_chance(float reflectance, std::uint8_t lobes) const {
    if (!(lobes & lobe::diffuse)) return 1;
    if (!(lobes & coat_lobe())) return 0;
    const float base = (1 - reflectance) * max_component(albedo), top = reflectance * max_component(tint);
    return top > 0 ? top / (top + base) : 0;
}

Rgb CoatedDiffuseBsdf::base_reflectance() const {
    const float inner = coat->inner_reflectance(facets);
    const auto series = [&](float rho) { return coat->series(rho, (base_colours_repeat ? rho : 1) * inner); };
    return {series(albedo.r), series(albedo.g), series(albedo.b)};
}

CosineChoices CoatedDiffuseBsdf::cosine_choices(float outgoing, std::uint8_t lobes) const {
    if (!(lobes & this->lobes())) return {};
    return {coat_chance(coat->reflectance(facets, outgoing), lobes), 1};
}

BsdfValue CoatedDiffuseBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (incoming.z <= 0 || !(lobes & lobe::rough & this->lobes())) return {};
    const float reflectance = coat->reflectance(facets, outgoing.z);
    const float chance = coat_chance(reflectance, lobes);
    BsdfValue sum;
    if (lobes & lobe::diffuse) {
        const float passes = coat->transmittance(facets, outgoing.z) * coat->transmittance(facets, incoming.z) /
                             (coat->eta() * coat->eta());
        sum.value += coated_base(base_reflectance(), passes, incoming.z);
        sum.pdf += (1 - chance) * incoming.z * inverse_pi;
    }
    if ((lobes & lobe::glossy) && !smooth()) {
        const auto [value, pdf, cosine] = reflection(facets, outgoing, incoming);
        sum.value += tint * (fresnel_dielectric(cosine, coat->eta()) * value);
        sum.pdf += chance * pdf;
    }
    return sum;
}

std::optional<BsdfSample> CoatedDiffuseBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes())) return {};
    const float reflectance = coat->reflectance(facets, outgoing.z);
    const float chance = coat_chance(reflectance, lobes);
    if (choice < chance && smooth())
        return BsdfSample{{-outgoing.x, -outgoing.y, outgoing.z}, tint * (reflectance / chance), 0, lobe::specular};
    const bool base = choice >= chance;
    const Vec3 incoming =
        base ? cosine_hemisphere(u) : normalize(reflect(outgoing, facets.sample_visible(outgoing, u)));
    const auto [value, pdf] = evaluate(outgoing, incoming, lobes);
    if (!(pdf > 0)) return {};
    return BsdfSample{incoming, value / pdf, pdf, base ? lobe::diffuse : lobe::glossy};
}

Coating CoatedDiffuseMaterial::coating(Coats& coats) const {
    return {&coats.coat(eta, facet_range_of(roughness), layer)};
}

CoatedDiffuseBsdf CoatedDiffuseMaterial::at(const MaterialInputs& inputs) const {
    return {inputs.albedo(reflectance), inputs.coating().coat, inputs.facets(roughness), inputs.tint(tint),
            base_colours_repeat};
}

}  // namespace lightnet
