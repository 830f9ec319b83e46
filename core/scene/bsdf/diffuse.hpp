// A perfectly diffuse reflector. All in the header: it is what most surfaces are.
#pragma once

#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

struct DiffuseBsdf {
    static constexpr bool two_sided = true;
    static constexpr bool chooses = false;
    Rgb albedo;

    std::uint8_t lobes() const { return lobe::diffuse; }

    CosineChoices cosine_choices(float, std::uint8_t lobes) const { return {0, lobes & lobe::diffuse ? 1.0f : 0.0f}; }
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

// The same in world space, as of any other model, without what only those need: of the outgoing direction no more than
// its side counts. Neither has a branch, so that loops over many surfaces become vectors.

/// Density of `incoming`, per steradian; 0 where surface and directions don't go together.
inline float diffuse_pdf(Vec3 shading, Vec3 normal, bool one_sided, Vec3 outgoing, Vec3 incoming) {
    const float seen = dot(outgoing, normal), lit = dot(incoming, normal);
    const float seen_shading = dot(outgoing, shading), lit_shading = dot(incoming, shading);
    const bool agree = (seen > 0) == (seen_shading > 0);
    const float from = agree ? seen_shading : seen, to = agree ? lit_shading : lit;
    const float height = from < 0 ? -to : to;
    const bool dark = (one_sided & (seen <= 0)) | (from == 0) | ((to > 0) != (lit > 0)) | (height <= 0);
    return dark ? 0 : height * inverse_pi;
}

struct DiffuseStep {
    Vec3 incoming;
    float pdf;  // 0: absorbed
};
/// In a frame whose z is on the viewer's side if `normal` is, and on the other if not.
inline DiffuseStep diffuse_step(const Frame& frame, Vec3 normal, Vec3 outgoing, Vec2 u) {
    const float from = dot(outgoing, frame.z);
    Vec3 local = cosine_hemisphere(u);
    const float pdf = from == 0 ? 0 : local.z * inverse_pi;
    local.z = from < 0 ? -local.z : local.z;
    const Vec3 incoming = normalize(frame.to_world(local));
    const bool leaks = (local.z > 0) != (dot(incoming, normal) > 0);
    return {incoming, leaks ? 0 : pdf};
}

}  // namespace lightnet
