// Matt surfaces: smooth ones, rough ones, and sheets that light shines through.
#pragma once

#include <optional>
#include <variant>

#include "core/scene/bsdf/diffuse.hpp"
#include "core/scene/bsdf/diffuse_transmission.hpp"
#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/rough_diffuse.hpp"

namespace lightnet {

/// Reflects evenly; rough in the sense of Oren and Nayar where sigma > 0. Lets light through evenly, too, where a
/// transmittance is given.
struct DiffuseMaterial {
    static constexpr const char* name = "diffuse";
    TextureId reflectance = 0;
    float sigma = 0;  // standard deviation of the facets' slopes, radians
    std::optional<TextureId> transmittance{};

    Transparency transparency() const { return transmittance ? Transparency::sheet : Transparency::opaque; }
    /// An ideal diffuse reflector, of equal radiance in all directions.
    bool lambertian() const { return !transmittance && !(sigma > 0); }
    std::variant<DiffuseBsdf, RoughDiffuseBsdf, DiffuseTransmissionBsdf> at(const MaterialInputs& inputs) const;
};
void visit_members(Is<DiffuseMaterial> auto& material, const auto& visit) {
    auto& [reflectance, sigma, transmittance] = material;
    visit(reflectance, sigma, transmittance);
}

}  // namespace lightnet
