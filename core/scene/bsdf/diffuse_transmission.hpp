// A sheet that scatters light evenly to both sides: paper, leaves, lampshades.
#pragma once

#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

struct DiffuseTransmissionBsdf {
    static constexpr bool two_sided = true;
    static constexpr bool chooses = true;
    Rgb reflected, transmitted;  // together at most 1

    std::uint8_t lobes() const { return lobe::diffuse; }

    float reflection_chance() const {
        const float r = max_component(reflected), t = max_component(transmitted);
        return r > 0 ? r / (r + t) : 0;
    }

    CosineChoices cosine_choices(float, std::uint8_t lobes) const {
        return {0, lobes & lobe::diffuse ? reflection_chance() : 0};
    }
    BsdfValue evaluate(Vec3, Vec3 incoming, std::uint8_t lobes) const {
        if (!(lobes & lobe::diffuse) || incoming.z == 0) return {};
        const bool above = incoming.z > 0;
        const float even = std::fabs(incoming.z) * inverse_pi, chance = reflection_chance();
        return {(above ? reflected : transmitted) * even, (above ? chance : 1 - chance) * even};
    }

    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
        Vec3 incoming = cosine_hemisphere(u);
        const bool through = choice >= reflection_chance();
        if (through) incoming.z = -incoming.z;
        const auto [value, pdf] = evaluate(outgoing, incoming, lobes);
        if (!(pdf > 0)) return {};
        return BsdfSample{incoming, value / pdf, pdf, lobe::diffuse, through};
    }
};

}  // namespace lightnet
