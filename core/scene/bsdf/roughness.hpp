// Roughness of a material, and the microfacets that it means.
#pragma once

#include <optional>

#include "core/scene/bsdf/microfacets.hpp"
#include "core/scene/textures/texture.hpp"

namespace lightnet {

/// Roughness of a surface's facets along its two tangents.
struct Roughness {
    float u = 0, v = 0;                                             // 0: smooth
    std::optional<TextureId> texture{};                             // times this
    enum class Means { alpha, root, square } means = Means::alpha;  // α = value, √value (pbrt), value² (glTF)
    FacetLaw law{};
};
void visit_members(Is<FacetLaw> auto& law, const auto& visit) {
    auto& [normals, masking] = law;
    visit(normals, masking);
}
void visit_members(Is<Roughness> auto& roughness, const auto& visit) {
    auto& [u, v, texture, means, law] = roughness;
    visit(u, v, texture, means, law);
}

/// Its facets where its texture says `factor`.
Microfacets facets_of(const Roughness& roughness, float factor);
/// Facets all over a surface: everywhere the same or, where they vary, of any α (the same along both tangents) and of
/// this law.
struct FacetRange {
    Microfacets facets{};
    bool varies = false;
};
FacetRange facet_range_of(const Roughness& roughness);

}  // namespace lightnet
