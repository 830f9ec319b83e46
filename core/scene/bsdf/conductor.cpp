#include "core/scene/bsdf/conductor.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {

BsdfValue ConductorBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::glossy) || smooth() || incoming.z <= 0) return {};
    return facets.law.with_normals([&]<class Law>(Law) {
        return SeenConductor<Law>::of(*this, outgoing.z, lobes).template value<false>(outgoing, incoming, {});
    });
}

std::optional<BsdfSample> ConductorBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes())) return {};
    if (smooth())
        return BsdfSample{
            {-outgoing.x, -outgoing.y, outgoing.z}, tint * fresnel_conductor(outgoing.z, eta, k), 0, lobe::specular};
    return facets.law.with_normals([&]<class Law>(Law) {
        return sample_seen(SeenConductor<Law>::of(*this, outgoing.z, lobes), *this, outgoing, choice, u);
    });
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
