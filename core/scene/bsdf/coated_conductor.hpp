// Metal under a dielectric coat: lacquered brass, car paint, carbon fibre.
#pragma once

#include "core/scene/bsdf/coat.hpp"
#include "core/scene/bsdf/coated_metal.hpp"
#include "core/scene/bsdf/conductor.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// What pbrt finds by random walks between the layers. Light is reflected by the coat, or bent into it, reflected by
/// the metal, partly sent back down any number of times, and bent out again. Smooth layers are exact. Of rough ones the
/// share of light that returns is that of walks; its directions are an approximation: those of the metal's facets, made
/// rougher by a rough coat that blurs what passes through it, however often the light met the metal.
struct CoatedConductorBsdf {
    static constexpr bool two_sided = true;
    static constexpr bool chooses = true;
    ConductorBsdf metal;                   // its index relative to the coat, its facets as they look through it
    const Coat* coat = nullptr;            // lives as long as the scene
    Microfacets facets{};                  // of the coat
    const CoatedMetal* between = nullptr;  // as long; not needed if all is smooth
    Microfacets below{};                   // the metal's own facets

    bool smooth() const { return is_specular(facets.alpha_u, facets.alpha_v); }
    std::uint8_t lobes() const {
        return static_cast<std::uint8_t>((smooth() ? lobe::specular : lobe::glossy) | metal.lobes());
    }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;

private:
    float coat_chance(Vec3 outgoing, std::uint8_t lobes) const;
    Rgb below_smooth(Vec3 outgoing) const;
    Rgb below_rough(Vec3 outgoing) const;
    BsdfValue metal_value(Vec3 outgoing, Vec3 incoming) const;
};

class Coats;

/// A metal under a dielectric coat.
struct CoatedConductorMaterial {
    static constexpr const char* name = "coated conductor";
    Metal metal{};
    Roughness roughness{};  // of the metal
    float coat_eta = 1.5f;  // over air; the metal's index is over air, too
    Roughness coat{};
    CoatLayer layer{};

    Transparency transparency() const { return Transparency::opaque; }
    Coating coating(Coats& coats) const;
    CoatedConductorBsdf at(const MaterialInputs& inputs) const;
};
void visit_members(Is<CoatedConductorMaterial> auto& material, const auto& visit) {
    auto& [metal, roughness, coat_eta, coat, layer] = material;
    visit(metal, roughness, coat_eta, coat, layer);
}

}  // namespace lightnet
