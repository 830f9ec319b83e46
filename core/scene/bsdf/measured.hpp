// A surface that reflects as it was measured: see Measurement.
#pragma once

#include <memory>
#include <optional>

#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/measurement.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// All that it reflects is one glossy lobe. From behind it is seen as turned about by a point, as in pbrt.
struct MeasuredBsdf {
    static constexpr bool two_sided = false, chooses = false;
    const Measurement* measured = nullptr;  // of a material, which lives longer

    std::uint8_t lobes() const { return lobe::glossy; }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

struct MeasuredMaterial {
    static constexpr const char* name = "measured";
    std::shared_ptr<const Measurement> measured{};  // null: black

    Transparency transparency() const { return Transparency::opaque; }
    MeasuredBsdf at(const MaterialInputs&) const { return {measured.get()}; }
};
void visit_members(Is<MeasuredMaterial> auto& material, const auto& visit) {
    auto& [measured] = material;
    visit(measured);
}

}  // namespace lightnet
