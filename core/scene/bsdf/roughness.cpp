#include "core/scene/bsdf/roughness.hpp"

#include <algorithm>
#include <cmath>

#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {
namespace {

float alpha_of(float value, Roughness::Means means) {
    switch (means) {
        case Roughness::Means::root:
            return std::sqrt(std::max(0.0f, value));
        case Roughness::Means::square:
            return value * value;
        default:
            return value;
    }
}

}  // namespace

// Roughness of a surface that isn't a perfect mirror in both directions must not be one in either.
Microfacets facets_of(const Roughness& roughness, float factor) {
    const float alpha_u = alpha_of(roughness.u * factor, roughness.means),
                alpha_v = alpha_of(roughness.v * factor, roughness.means);
    if (is_specular(alpha_u, alpha_v)) return {};
    return {std::max(alpha_u, specular_alpha), std::max(alpha_v, specular_alpha), roughness.law};
}

FacetRange facet_range_of(const Roughness& roughness) {
    if (roughness.texture) return {{0, 0, roughness.law}, true};
    return {facets_of(roughness, 1)};
}

}  // namespace lightnet
