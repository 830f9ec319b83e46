#include "core/scene/bsdf/dielectric.hpp"

#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"

namespace lightnet {

BsdfValue DielectricBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::glossy) || smooth() || outgoing.z == 0 || incoming.z == 0) return {};
    const float side = outgoing.z > 0 ? 1.0f : -1.0f;
    const bool reflected = outgoing.z * incoming.z > 0;
    const auto [value, pdf, cosine] =
        reflected ? reflection(facets, outgoing * side, incoming * side) : refraction(facets, outgoing, incoming, eta);
    if (cosine == 0) return {};
    const float reflectance = fresnel_dielectric(reflected ? cosine * side : cosine, eta);
    const float chance = tints.reflection_chance(reflectance);
    if (reflected) return {tints.reflected * (reflectance * value), chance * pdf};
    return {tints.transmitted * ((1 - reflectance) * value), (1 - chance) * pdf};
}

std::optional<BsdfSample> DielectricBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes()) || outgoing.z == 0) return {};
    if (smooth()) return sample_smooth(outgoing, choice);
    const Vec3 m = facets.sample_visible(outgoing, u);
    const bool reflected = choice < tints.reflection_chance(fresnel_dielectric(dot(outgoing, m), eta));
    BsdfSample result{{}, {}, 0, lobe::glossy, !reflected};
    if (reflected) {
        result.incoming = normalize(reflect(outgoing, m));
    } else {
        const Refracted refracted = refract(outgoing, m, eta);
        if (!refracted.possible) return {};
        result.incoming = normalize(refracted.direction);
        result.eta = refracted.eta;
    }
    if ((result.incoming.z * outgoing.z > 0) != reflected || result.incoming.z == 0) return {};
    const auto [value, pdf] = evaluate(outgoing, result.incoming, lobe::glossy);
    if (!(pdf > 0)) return {};
    result.weight = value / pdf;
    result.pdf = pdf;
    return result;
}

float DielectricBsdf::reflection_chance(Vec3 outgoing) const {
    return tints.reflection_chance(fresnel_dielectric(outgoing.z, eta));
}

std::optional<BsdfSample> DielectricBsdf::sample_smooth(Vec3 outgoing, float choice) const {
    const float reflectance = fresnel_dielectric(outgoing.z, eta), chance = tints.reflection_chance(reflectance);
    if (choice < chance)
        return BsdfSample{
            {-outgoing.x, -outgoing.y, outgoing.z}, tints.reflected * (reflectance / chance), 0, lobe::specular};
    const Refracted refracted = refract(outgoing, {0, 0, 1}, eta);
    if (!refracted.possible) return {};
    const Rgb weight = tints.transmitted * ((1 - reflectance) / (1 - chance) / (refracted.eta * refracted.eta));
    return BsdfSample{normalize(refracted.direction), weight, 0, lobe::specular, true, refracted.eta};
}

// Light that goes back and forth inside the pane: a geometric series.
float ThinDielectricBsdf::reflectance(Vec3 outgoing) const {
    const float once = fresnel_dielectric(outgoing.z, eta);
    return once < 1 ? 2 * once / (1 + once) : once;
}

std::optional<BsdfSample> ThinDielectricBsdf::sample(Vec3 outgoing, float choice, Vec2, std::uint8_t lobes) const {
    if (!(lobes & lobe::specular)) return {};
    const float reflectance = this->reflectance(outgoing);
    const float chance = tints.reflection_chance(reflectance);
    if (choice < chance)
        return BsdfSample{
            {-outgoing.x, -outgoing.y, outgoing.z}, tints.reflected * (reflectance / chance), 0, lobe::specular};
    return BsdfSample{-outgoing, tints.transmitted * ((1 - reflectance) / (1 - chance)), 0, lobe::specular, true};
}

std::variant<DielectricBsdf, ThinDielectricBsdf> DielectricMaterial::at(const MaterialInputs& inputs) const {
    const GlassTints tints{inputs.tint(reflected), inputs.tint(transmitted)};
    if (thin) return ThinDielectricBsdf{eta, tints};
    return DielectricBsdf{eta, inputs.facets(roughness), tints};
}

}  // namespace lightnet
