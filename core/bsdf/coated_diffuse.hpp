// A diffuse base under a dielectric coat: plastic, varnish, glazed clay.
#pragma once

#include <array>

#include "core/bsdf/ggx.hpp"
#include "core/bsdf/scattering.hpp"

namespace lightnet {

/// What is known of a coat before its base is: made once per material.
class Coat {
public:
    Coat(float eta, float alpha_u, float alpha_v);

    float eta() const { return eta_; }
    const Ggx& facets() const { return facets_; }
    bool smooth() const { return is_specular(facets_.alpha_u, facets_.alpha_v); }
    /// Share of light from direction `cosine` that the coat itself reflects.
    float reflectance(float cosine) const;
    /// Share of diffuse light from below that the coat sends back down.
    float inner_reflectance() const { return inner_; }

private:
    static constexpr std::size_t steps = 64;
    float eta_;
    Ggx facets_;
    std::array<float, steps + 1> table_{};  // by cosine; used by rough coats
    float inner_ = 0;
};

/// An approximation of what pbrt finds by random walks between the layers: light is reflected by the coat, or enters
/// it, is scattered by the base, partly sent back down by the coat any number of times (a geometric series), and
/// leaves. Neither thickness nor a medium in between. A white base under any coat reflects everything.
struct CoatedDiffuseBsdf {
    static constexpr bool two_sided = true;
    Rgb albedo;                  // of the base
    const Coat* coat = nullptr;  // lives as long as the scene

    std::uint8_t coat_lobe() const { return coat->smooth() ? lobe::specular : lobe::glossy; }
    std::uint8_t lobes() const { return static_cast<std::uint8_t>(coat_lobe() | lobe::diffuse); }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;

private:
    float coat_chance(float reflectance, std::uint8_t lobes) const;
    Rgb base_value(float reflectance, Vec3 incoming) const;
    BsdfValue coat_value(Vec3 outgoing, Vec3 incoming) const;
};

}  // namespace lightnet
