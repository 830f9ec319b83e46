// Fibres of hair and fur: Chiang et al. 2016, "A Practical and Controllable Hair and Fur Model for Production Path
// Tracing", upon d'Eon et al. 2011, "An Energy-Conserving Hair Reflectance Model".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// A point on a fibre of glass that is rough and absorbs, x along the fibre from its root. Light is reflected (R), goes
/// through (TT), through with a reflection inside (TRT), or through with more of them: one glossy lobe, whose
/// directions may lie all around. The whole fibre is in it: light leaves where it came in.
struct HairBsdf {
    static constexpr bool two_sided = true, chooses = true;
    static constexpr std::size_t ways = 4;

    /// How light is spread along the fibre on one of the first three ways; the rest is spread as the third is.
    struct Along {
        float variance = 0, whole = 0;  // the second: of what isn't scaled yet, its integral over 2π
        SineCosine scales{0, 1};        // of the angle by which scales turn the viewer's direction
    };
    Rgb absorption;                // over a radius of the fibre
    float eta = 1.55f;             // 1 or more
    float spread = 0, within = 1;  // around the fibre: a logistic distribution's scale, turns, and its part in one turn
    std::array<Along, 3> along{};
    /// Where across its width the fibre is seen, -1 … 1; none: where a viewer sees its normal, as it is round.
    /// DECISIONS: hair-where-it-is-seen
    std::optional<float> across{};

    std::uint8_t lobes() const { return lobe::glossy; }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

/// What roughens a fibre.
struct HairSurface {
    static constexpr float smoothest = 0.01f;  // a roughness below this is this
    float along = 0.3f, around = 0.3f;         // roughness, 0 … 1: β_m and β_n
    float tilt = 2;                            // of its scales, degrees
};
HairBsdf hair_fibre(Rgb absorption, float eta, const HairSurface& surface);

/// The absorption with which much hair together has that colour: Chiang et al., section 4.2. `around` as of
/// HairSurface.
Rgb hair_absorption(Rgb colour, float around);
/// That of a concentration of the two pigments of hair: d'Eon et al., in RGB as pbrt has it.
Rgb melanin_absorption(float eumelanin, float pheomelanin);

struct HairMaterial {
    static constexpr const char* name = "hair";
    enum class Colour {
        absorption,   // over a radius
        reflectance,  // of much hair together
        melanin       // concentration of eumelanin; that of pheomelanin stands beside it
    };
    TextureId colour = 0, pheomelanin = 0;
    Colour means = Colour::absorption;
    TextureId eta = 0, along = 0, around = 0, tilt = 0;  // as of HairBsdf and HairSurface
    bool across_by_v = false;  // but on round curves, texture coordinate v goes across what is seen of a fibre

    Transparency transparency() const { return Transparency::sheet; }
    HairBsdf at(const MaterialInputs& inputs) const;
};
void visit_members(Is<HairMaterial> auto& material, const auto& visit) {
    auto& [colour, pheomelanin, means, eta, along, around, tilt, across_by_v] = material;
    visit(colour, pheomelanin, means, eta, along, around, tilt, across_by_v);
}

}  // namespace lightnet
