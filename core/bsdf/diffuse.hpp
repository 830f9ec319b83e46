// A perfectly diffuse reflector.
#pragma once

#include "core/bsdf/scattering.hpp"

namespace lightnet {

struct DiffuseBsdf {
    static constexpr bool two_sided = true;
    Rgb albedo;

    std::uint8_t lobes() const { return lobe::diffuse; }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

}  // namespace lightnet
