// Glass: reflects and refracts, smooth or with microfacets (Walter et al. 2007). The normal points outside.
#pragma once

#include <optional>
#include <variant>

#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/microfacets.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// Tints of glass: not physical, but in files.
struct GlassTints {
    Rgb reflected{1, 1, 1}, transmitted{1, 1, 1};

    /// With which probability reflection is chosen where that share of the light is reflected.
    float reflection_chance(float reflectance) const {
        const float r = reflectance * max_component(reflected), t = (1 - reflectance) * max_component(transmitted);
        return r > 0 ? r / (r + t) : 0;
    }
};

/// Transmitted radiance is scaled by the square of the ratio of indices, as radiance is.
struct DielectricBsdf {
    static constexpr bool two_sided = false;
    static constexpr bool chooses = true;
    float eta = 1.5f;  // inside over outside
    Microfacets facets{};
    GlassTints tints{};

    bool smooth() const { return eta == 1 || is_specular(facets.alpha_u, facets.alpha_v); }
    std::uint8_t lobes() const { return smooth() ? lobe::specular : lobe::glossy; }
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
    float reflection_chance(Vec3 outgoing) const;  // of smooth glass

private:
    std::optional<BsdfSample> sample_smooth(Vec3 outgoing, float choice) const;
};

/// A pane of glass whose two sides are taken together: nothing is bent.
struct ThinDielectricBsdf {
    static constexpr bool two_sided = true;
    static constexpr bool chooses = true;
    float eta = 1.5f;
    GlassTints tints{};

    std::uint8_t lobes() const { return lobe::specular; }
    BsdfValue evaluate(Vec3, Vec3, std::uint8_t) const { return {}; }
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
    float reflection_chance(Vec3 outgoing) const { return tints.reflection_chance(reflectance(outgoing)); }

private:
    float reflectance(Vec3 outgoing) const;
};

struct DielectricMaterial {
    static constexpr const char* name = "dielectric";
    float eta = 1.5f;  // inside over outside (outside: where the normal points)
    Roughness roughness{};
    std::optional<TextureId> reflected{}, transmitted{};  // not physical, but in files: tints
    bool thin = false;                                    // a pane: what enters leaves on the other side, undeflected

    Transparency transparency() const { return thin ? Transparency::sheet : Transparency::solid; }
    std::variant<DielectricBsdf, ThinDielectricBsdf> at(const MaterialInputs& inputs) const;
};
void visit_members(Is<DielectricMaterial> auto& material, const auto& visit) {
    auto& [eta, roughness, reflected, transmitted, thin] = material;
    visit(eta, roughness, reflected, transmitted, thin);
}

/// Not there: light goes straight through (a border between media, say).
struct NoMaterial {
    static constexpr const char* name = "nothing";
    Transparency transparency() const { return Transparency::sheet; }
    /// A pane of air.
    ThinDielectricBsdf at(const MaterialInputs&) const { return {1, {}}; }
};
void visit_members(Is<NoMaterial> auto&, const auto&) { static_assert(std::is_empty_v<NoMaterial>); }

}  // namespace lightnet
