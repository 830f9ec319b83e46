// Metal: a mirror, or GGX microfacets of mirror. Single scattering: rough metals lose some energy, as in pbrt.
#pragma once

#include "core/scene/bsdf/ggx.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

struct ConductorBsdf {
    static constexpr bool two_sided = true;
    Rgb eta, k;  // complex index of refraction
    Ggx facets{};
    Rgb tint{1, 1, 1};

    bool smooth() const { return is_specular(facets.alpha_u, facets.alpha_v); }
    std::uint8_t lobes() const { return smooth() ? lobe::specular : lobe::glossy; }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

/// k of a metal of index 1 + i k that reflects `reflectance` at normal incidence, as pbrt takes it.
Rgb absorption_for(Rgb reflectance);

}  // namespace lightnet
