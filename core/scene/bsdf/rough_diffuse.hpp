// Rough diffuse surfaces: clay, plaster, the moon.
#pragma once

#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// The energy-preserving model after Oren and Nayar (Portsmouth, Kutz and Hill 2025): single scattering as Fujii
/// writes it, and what is scattered more often, so that a white surface loses nothing.
struct RoughDiffuseBsdf {
    static constexpr bool two_sided = true;
    static constexpr bool chooses = false;
    Rgb albedo;           // of the facets
    float roughness = 0;  // 0 … 1

    std::uint8_t lobes() const { return lobe::diffuse; }
    CosineChoices cosine_choices(float, std::uint8_t lobes) const { return {0, lobes & lobe::diffuse ? 1.0f : 0.0f}; }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

/// The roughness with which single scattering has the same ratio of its two terms as Oren and Nayar's (1994) with
/// slopes of standard deviation `sigma`, radians.
float roughness_of_slopes(float sigma);

}  // namespace lightnet
