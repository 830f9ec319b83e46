#include "core/scene/bsdf/coats.hpp"

#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {
namespace {

/// Three numbers that say which roughness; those of none are no one's.
std::array<float, 3> key_of(const std::optional<Ggx>& facets) {
    return facets ? std::array{1.0f, facets->alpha_u, facets->alpha_v} : std::array{0.0f, 0.0f, 0.0f};
}

bool smooth(const std::optional<Ggx>& facets) { return facets && is_specular(facets->alpha_u, facets->alpha_v); }

}  // namespace

const Coat& Coats::coat(float eta, const std::optional<Ggx>& facets, CoatLayer layer) {
    const auto [any, u, v] = key_of(facets);
    auto& made = coats_[{eta, layer.thickness, float(layer.bounces), any, u, v}];
    if (!made)
        made = facets ? std::make_unique<const Coat>(eta, *facets, layer) : std::make_unique<const Coat>(eta, layer);
    return *made;
}

const CoatedMetal* Coats::over_metal(const Coat& coat, const std::optional<Ggx>& above,
                                     const std::optional<Ggx>& below) {
    if (smooth(above) && smooth(below)) return nullptr;
    const auto [any, u, v] = key_of(above);
    const auto [any_below, u_below, v_below] = key_of(below);
    auto& made = over_metals_[{&coat, {any, u, v, any_below, u_below, v_below}}];
    if (!made) made = std::make_unique<const CoatedMetal>(coat, above, below);
    return made.get();
}

}  // namespace lightnet
