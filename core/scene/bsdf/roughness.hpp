// How rough a material says it is, and the microfacets that it means.
#pragma once

#include <optional>

#include "core/scene/bsdf/ggx.hpp"
#include "core/scene/textures/texture.hpp"

namespace lightnet {

/// Roughness of a surface's facets along its two tangents.
struct Roughness {
    float u = 0, v = 0;                                             // 0: smooth
    std::optional<TextureId> texture{};                             // times this
    enum class Means { alpha, root, square } means = Means::alpha;  // GGX α = value, √value (pbrt), value² (glTF)
};
void visit_members(Is<Roughness> auto& roughness, const auto& visit) {
    auto& [u, v, texture, means] = roughness;
    visit(u, v, texture, means);
}

/// Its facets where its texture says `factor`.
Ggx facets_of(const Roughness& roughness, float factor);
/// None: they change over the surface.
std::optional<Ggx> only_facets_of(const Roughness& roughness);

}  // namespace lightnet
