#include "core/scene/bsdf/measured.hpp"

namespace lightnet {

BsdfValue MeasuredBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::glossy) || !measured || !(outgoing.z * incoming.z > 0)) return {};
    return outgoing.z > 0 ? measured->value(outgoing, incoming) : measured->value(-outgoing, -incoming);
}

std::optional<BsdfSample> MeasuredBsdf::sample(Vec3 outgoing, float, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & lobe::glossy) || !measured || outgoing.z == 0) return {};
    const Vec3 upright = outgoing.z > 0 ? outgoing : -outgoing;
    const Vec3 facet = measured->sample_facet(upright, u);
    const Vec3 incoming = normalize(facet * (2 * dot(upright, facet)) - upright);
    if (!(incoming.z > 0)) return {};
    BsdfSample found;
    found.incoming = outgoing.z > 0 ? incoming : -incoming;
    found.lobe = lobe::glossy;
    return weighed(found, measured->value(upright, incoming));
}

}  // namespace lightnet
