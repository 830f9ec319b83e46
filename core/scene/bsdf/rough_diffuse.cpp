#include "core/scene/bsdf/rough_diffuse.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math/sampling.hpp"

namespace lightnet {
namespace {

// Portsmouth, Kutz and Hill 2025, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", sections 2 and 3.
constexpr float constant1 = 0.5f - 2 * inverse_pi / 3, constant2 = 2.0f / 3 - 28 * inverse_pi / 15;

/// Share of the light from a direction that white facets reflect by scattering it once.
float once(float cosine, float roughness) {
    cosine = std::clamp(cosine, 1e-4f, 1.0f);
    const float a = 1 / (1 + constant1 * roughness);
    const float sine = std::sqrt(1 - cosine * cosine);
    const float g =
        sine * (std::acos(cosine) - sine * cosine) + 2.0f / 3 * (sine / cosine * (1 - sine * sine * sine) - sine);
    return a * (1 + roughness * inverse_pi * g);
}

}  // namespace

float roughness_of_slopes(float sigma) {
    const float s2 = sigma * sigma;
    const float a = 1 - 0.5f * s2 / (s2 + 0.33f), b = 0.45f * s2 / (s2 + 0.09f);
    return std::min(1.0f, b / a);
}

BsdfValue RoughDiffuseBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::diffuse) || incoming.z <= 0) return {};
    const float s = outgoing.x * incoming.x + outgoing.y * incoming.y;
    const float slope = s > 0 ? s / std::max(outgoing.z, incoming.z) : s;
    const float a = 1 / (1 + constant1 * roughness), mean = a * (1 + constant2 * roughness);
    const float single = a * (1 + roughness * slope);
    const float lost =
        std::max(0.0f, 1 - once(outgoing.z, roughness)) * std::max(0.0f, 1 - once(incoming.z, roughness));
    const auto value = [&](float rho) {
        const float more = rho * rho * mean / (1 - rho * (1 - mean)) * lost / std::max(1e-7f, 1 - mean);
        return (rho * single + more) * incoming.z * inverse_pi;
    };
    return {{value(albedo.r), value(albedo.g), value(albedo.b)}, incoming.z * inverse_pi};
}

std::optional<BsdfSample> RoughDiffuseBsdf::sample(Vec3 outgoing, float, Vec2 u, std::uint8_t lobes) const {
    const Vec3 incoming = cosine_hemisphere(u);
    const auto [value, pdf] = evaluate(outgoing, incoming, lobes);
    if (!(pdf > 0)) return {};
    return BsdfSample{incoming, value / pdf, pdf, lobe::diffuse};
}

}  // namespace lightnet
