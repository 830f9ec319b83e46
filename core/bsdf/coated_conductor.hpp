// Metal under a dielectric coat: lacquered brass, car paint, carbon fibre.
#pragma once

#include "core/bsdf/coat.hpp"
#include "core/bsdf/conductor.hpp"
#include "core/bsdf/scattering.hpp"

namespace lightnet {

/// An approximation of what pbrt finds by random walks between the layers. Light is reflected by the coat, or bent into
/// it, reflected by the metal, partly sent back down any number of times (a geometric series), and bent out again.
/// Smooth layers are exact. A rough coat blurs what passes through it: it makes the metal's facets rougher.
struct CoatedConductorBsdf {
    static constexpr bool two_sided = true;
    ConductorBsdf metal;         // its index relative to the coat
    const Coat* coat = nullptr;  // lives as long as the scene
    Ggx facets{};                // of the coat

    /// The metal's facets, as they look through those of a coat.
    static Ggx seen_through(const Ggx& metal, const Ggx& coat, float eta);

    bool smooth() const { return is_specular(facets.alpha_u, facets.alpha_v); }
    std::uint8_t lobes() const {
        return static_cast<std::uint8_t>((smooth() ? lobe::specular : lobe::glossy) | metal.lobes());
    }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;

private:
    float coat_chance(Vec3 outgoing, std::uint8_t lobes) const;
    Rgb through(float cosine, float reflected_o, float reflected_i, float left) const;
    BsdfValue metal_value(Vec3 outgoing, Vec3 incoming) const;
    Vec3 inwards(Vec3 w) const;
    std::optional<Vec3> outwards(Vec3 w) const;
};

}  // namespace lightnet
