// A perfectly diffuse reflector. All in the header: it is what most surfaces are.
#pragma once

#include "core/bsdf/scattering.hpp"
#include "core/math/sampling.hpp"

namespace lightnet {

struct DiffuseBsdf {
    static constexpr bool two_sided = true;
    Rgb albedo;

    std::uint8_t lobes() const { return lobe::diffuse; }

    BsdfValue evaluate(Vec3, Vec3 incoming, std::uint8_t lobes) const {
        if (!(lobes & lobe::diffuse) || incoming.z <= 0) return {};
        const float pdf = incoming.z * inverse_pi;
        return {albedo * pdf, pdf};
    }

    std::optional<BsdfSample> sample(Vec3, float, Vec2 u, std::uint8_t lobes) const {
        if (!(lobes & lobe::diffuse)) return {};
        const Vec3 incoming = cosine_hemisphere(u);
        if (incoming.z <= 0) return {};
        return BsdfSample{incoming, albedo, incoming.z * inverse_pi, lobe::diffuse};
    }
};

}  // namespace lightnet
