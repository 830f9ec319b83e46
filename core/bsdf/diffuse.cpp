#include "core/bsdf/diffuse.hpp"

#include "core/math/sampling.hpp"

namespace lightnet {

BsdfValue DiffuseBsdf::evaluate(Vec3, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::diffuse) || incoming.z <= 0) return {};
    const float pdf = incoming.z * inverse_pi;
    return {albedo * pdf, pdf};
}

std::optional<BsdfSample> DiffuseBsdf::sample(Vec3, float, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & lobe::diffuse)) return {};
    const Vec3 incoming = cosine_hemisphere(u);
    if (incoming.z <= 0) return {};
    return BsdfSample{incoming, albedo, incoming.z * inverse_pi, lobe::diffuse};
}

}  // namespace lightnet
