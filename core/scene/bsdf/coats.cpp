#include "core/scene/bsdf/coats.hpp"

#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {
namespace {

std::array<float, 5> key_of(const FacetRange& range) {
    const auto& [u, v, law] = range.facets;
    return {float(range.varies), u, v, float(law.normals), float(law.masking)};
}

bool smooth(const FacetRange& range) {
    return !range.varies && is_specular(range.facets.alpha_u, range.facets.alpha_v);
}

}  // namespace

const Coat& Coats::coat(float eta, const FacetRange& facets, CoatLayer layer) {
    auto& made = coats_[{eta, key_of(facets), layer.thickness, layer.bounces}];
    if (!made) made = std::make_unique<const Coat>(eta, facets, layer);
    return *made;
}

const CoatedMetal* Coats::over_metal(const Coat& coat, const FacetRange& above, const FacetRange& below) {
    if (smooth(above) && smooth(below)) return nullptr;
    auto& made = over_metals_[{&coat, key_of(above), key_of(below)}];
    if (!made) made = std::make_unique<const CoatedMetal>(coat, above, below);
    return made.get();
}

}  // namespace lightnet
