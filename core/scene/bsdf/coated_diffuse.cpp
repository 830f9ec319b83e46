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
    return facets.law.with_normals([&]<class Law>(Law) {
        using Seen = SeenCoatedDiffuse<Law>;
        return Seen::of(*this, outgoing.z, lobes)
            .template value<false>(outgoing, incoming, Seen::arriving(*this, incoming.z));
    });
}

std::optional<BsdfSample> CoatedDiffuseBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes())) return {};
    return facets.law.with_normals([&]<class Law>(Law) {
        return sample_seen(SeenCoatedDiffuse<Law>::of(*this, outgoing.z, lobes), *this, outgoing, choice, u);
    });
}

Coating CoatedDiffuseMaterial::coating(Coats& coats) const {
    return {&coats.coat(eta, facet_range_of(roughness), layer)};
}

CoatedDiffuseBsdf CoatedDiffuseMaterial::at(const MaterialInputs& inputs) const {
    return {inputs.albedo(reflectance), inputs.coating().coat, inputs.facets(roughness), inputs.tint(tint),
            base_colours_repeat};
}

}  // namespace lightnet
