// How one point of a surface scatters light.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "core/bsdf/coated_diffuse.hpp"
#include "core/bsdf/conductor.hpp"
#include "core/bsdf/dielectric.hpp"
#include "core/bsdf/diffuse.hpp"
#include "core/bsdf/scattering.hpp"
#include "core/light/query.hpp"
#include "core/math/frame.hpp"
#include "core/math/rgb.hpp"
#include "core/math/vec.hpp"

namespace lightnet {

/// Scattering at one point, textures already looked up. A value: make it, use it, drop it. Both directions are unit,
/// in world space and point away from the surface. Reflection stays on the geometric normal's side of the surface and
/// transmission goes to the other one, whatever the shading normal says, so that no light leaks.
class Bsdf {
public:
    /// The first two have nothing to choose from.
    using Model = std::variant<DiffuseBsdf, ConductorBsdf, DielectricBsdf, ThinDielectricBsdf, CoatedDiffuseBsdf>;

    Bsdf(const Frame& shading, Vec3 normal, const Model& model) : shading_(shading), normal_(normal), model_(model) {}

    /// Which lobes the surface has.
    std::uint8_t lobes() const;
    /// Does sample() look at its `choice`?
    bool chooses() const { return model_.index() > 1; }
    /// f × |cos incoming| for the non-specular lobes among `lobes`, sr⁻¹; and the density with which sample() with the
    /// same `lobes` finds `incoming`, per steradian. Both exactly 0 for specular lobes.
    BsdfValue value_and_pdf(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    Rgb evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
        return value_and_pdf(outgoing, incoming, lobes).value;
    }
    float pdf(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
        return value_and_pdf(outgoing, incoming, lobes).pdf;
    }
    /// One direction of light, by importance. None: absorbed.
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;

private:
    Frame frame_for(Vec3 outgoing) const;

    Frame shading_;
    Vec3 normal_;  // geometric
    Model model_;
};

}  // namespace lightnet
