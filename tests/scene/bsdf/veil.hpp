// Veil: light goes straight through and takes the veil's colour. The example of a material in CONTRIBUTING.md.
#pragma once

#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// How it scatters at a place, its textures looked up.
struct VeilBsdf {
    static constexpr bool two_sided = true, chooses = false;
    Rgb colour;

    std::uint8_t lobes() const { return lobe::specular; }
    BsdfValue evaluate(Vec3, Vec3, std::uint8_t) const { return {}; }
    std::optional<BsdfSample> sample(Vec3 outgoing, float, Vec2, std::uint8_t lobes) const {
        if (!(lobes & lobe::specular)) return {};
        return BsdfSample{-outgoing, colour, 0, lobe::specular, true};
    }
};

/// What a scene says of it.
struct VeilMaterial {
    static constexpr const char* name = "veil";
    TextureId colour = 0;

    Transparency transparency() const { return Transparency::sheet; }
    VeilBsdf at(const MaterialInputs& inputs) const { return {inputs.albedo(colour)}; }
};
void visit_members(Is<VeilMaterial> auto& material, const auto& visit) {
    auto& [colour] = material;
    visit(colour);
}

}  // namespace lightnet
