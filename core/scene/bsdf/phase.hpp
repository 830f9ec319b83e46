// Phase functions: how a medium scatters light.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bsdf/scattering.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

/// Density of directions after a collision, by the cosine between light's direction before and after: 1 goes straight
/// on. A constant value.
struct PhaseFunction {
    enum class Law : std::uint8_t {
        isotropic,
        henyey_greenstein,  // Henyey & Greenstein 1941, of mean cosine `g`
        rayleigh,           // of particles that are small beside the wavelength
        tabulated,          // linear between the densities in `table`
        blend               // of `parts`, in the shares that `table` says
    };
    Law law = Law::isotropic;
    float g = 0;                 // -1 … 1, without these
    std::vector<float> table{};  // tabulated: at evenly spaced cosines from -1 to 1, two at least
    std::vector<PhaseFunction> parts{};

    /// Why it can't be used; "": it can.
    std::string fault() const;
    /// The integral over all directions becomes 1: a table's densities are scaled, and so are shares.
    void normalise();

    /// Per steradian.
    float density(float cosine) const;
    /// A cosine, with density 2π × density(): `u` in [0, 1), `choice` among parts.
    float cosine(float choice, float u) const;
};
void visit_members(Is<PhaseFunction> auto& phase, const auto& visit) {
    auto& [law, g, table, parts] = phase;
    visit(law, g, table, parts);
}

/// One collision: what a Bsdf is at a point in space. Keeps looking at its phase function.
struct PhaseBsdf {
    static constexpr bool two_sided = false;
    static constexpr bool chooses = true;
    const PhaseFunction* phase = nullptr;
    Rgb albedo;  // share of the light that is scattered, not absorbed

    std::uint8_t lobes() const { return lobe::diffuse; }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

}  // namespace lightnet
