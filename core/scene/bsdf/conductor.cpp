#include "core/scene/bsdf/conductor.hpp"

#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"

namespace lightnet {

BsdfValue ConductorBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::glossy) || smooth() || incoming.z <= 0) return {};
    const auto [value, pdf, cosine] = reflection(facets, outgoing, incoming);
    if (!(cosine > 0)) return {};
    return {tint * fresnel_conductor(cosine, eta, k) * value, pdf};
}

std::optional<BsdfSample> ConductorBsdf::sample(Vec3 outgoing, float, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes())) return {};
    if (smooth())
        return BsdfSample{
            {-outgoing.x, -outgoing.y, outgoing.z}, tint * fresnel_conductor(outgoing.z, eta, k), 0, lobe::specular};
    const Vec3 m = facets.sample_visible(outgoing, u);
    const Vec3 incoming = normalize(reflect(outgoing, m));
    if (incoming.z <= 0) return {};
    const auto [value, pdf] = evaluate(outgoing, incoming, lobe::glossy);
    if (pdf <= 0) return {};
    return BsdfSample{incoming, value / pdf, pdf, lobe::glossy};
}

Rgb absorption_for(Rgb reflectance) {
    const auto of = [](float r) {
        r = std::clamp(r, 0.0f, 0.9999f);
        return 2 * std::sqrt(r) / std::sqrt(1 - r);
    };
    return {of(reflectance.r), of(reflectance.g), of(reflectance.b)};
}

ConductorBsdf Metal::at(const MaterialInputs& inputs, const Microfacets& facets) const {
    if (reflectance) return {{1, 1, 1}, absorption_for(inputs.colour(*reflectance)), facets};
    return {inputs.colour(eta), inputs.colour(k), facets};
}

ConductorBsdf ConductorMaterial::at(const MaterialInputs& inputs) const {
    ConductorBsdf model = metal.at(inputs, inputs.facets(roughness));
    model.tint = inputs.tint(tint) * strength;
    return model;
}

}  // namespace lightnet
