// A diffuse base under a dielectric coat: plastic, varnish, glazed clay.
#pragma once

#include <optional>

#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/coat.hpp"
#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// What pbrt finds by random walks between the layers: light is reflected by the coat, or enters it, is scattered by
/// the base, partly sent back down by the coat any number of times (a geometric series), and leaves. Since the base
/// forgets where light came from the sum is exact for smooth and for rough coats. A white base under a smooth coat that
/// absorbs nothing reflects everything; rough coats lose what single scattering loses.
struct CoatedDiffuseBsdf {
    static constexpr bool two_sided = true;
    static constexpr bool chooses = true;
    Rgb albedo;                  // of the base
    const Coat* coat = nullptr;  // lives as long as the scene
    Microfacets facets{};        // of the coat
    Rgb tint{1, 1, 1};           // of the coat's reflection
    bool base_colours_repeat = true;

    bool smooth() const { return is_specular(facets.alpha_u, facets.alpha_v); }
    std::uint8_t coat_lobe() const { return smooth() ? lobe::specular : lobe::glossy; }
    std::uint8_t lobes() const { return static_cast<std::uint8_t>(coat_lobe() | lobe::diffuse); }
    /// With which probability the coat is sampled, not the base, where it reflects that share.
    float coat_chance(float reflectance, std::uint8_t lobes) const;
    /// What all ways off the base come to, by colour: without what the coat lets in and out.
    Rgb base_reflectance() const;
    CosineChoices cosine_choices(float outgoing, std::uint8_t lobes) const;
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
};

/// What the base sends on: `passes` is what the coat lets in and out, where radiance shrinks by η².
inline Rgb coated_base(Rgb reflectance, float passes, float cosine) {
    return reflectance * (passes * cosine * inverse_pi);
}

class Coats;

/// A diffuse base under a dielectric coat.
struct CoatedDiffuseMaterial {
    static constexpr const char* name = "coated diffuse";
    TextureId reflectance = 0;  // of the base
    float eta = 1.5f;
    Roughness roughness{};            // of the coat
    std::optional<TextureId> tint{};  // not physical, but in files: times the coat's reflection
    bool base_colours_repeat = true;  // light that goes back and forth below the coat takes the base's colour each time
    CoatLayer layer{};

    Transparency transparency() const { return Transparency::opaque; }
    Coating coating(Coats& coats) const;
    CoatedDiffuseBsdf at(const MaterialInputs& inputs) const;
};
void visit_members(Is<CoatedDiffuseMaterial> auto& material, const auto& visit) {
    auto& [reflectance, eta, roughness, tint, base_colours_repeat, layer] = material;
    visit(reflectance, eta, roughness, tint, base_colours_repeat, layer);
}

}  // namespace lightnet
