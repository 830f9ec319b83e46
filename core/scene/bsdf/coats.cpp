#include "core/scene/bsdf/coats.hpp"

#include <algorithm>
#include <utility>

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

struct Coats::OverMetal {
    std::shared_ptr<const Coat> coat;
    CoatedMetal metal;
};

SharedWork<Coats::CoatKey, Coat>& Coats::all_coats() {
    static SharedWork<CoatKey, Coat> all;
    return all;
}

SharedWork<Coats::MetalKey, Coats::OverMetal>& Coats::all_over_metals() {
    static SharedWork<MetalKey, OverMetal> all;
    return all;
}

const Coat& Coats::coat(float eta, const FacetRange& facets, CoatLayer layer) {
    const CoatKey key{eta, key_of(facets), layer.thickness, layer.bounces};
    auto& made = coats_[key];
    if (!made) made = all_coats().get(key, [&] { return std::make_shared<const Coat>(eta, facets, layer); });
    return *made;
}

const CoatedMetal* Coats::over_metal(const Coat& coat, const FacetRange& above, const FacetRange& below) {
    if (smooth(above) && smooth(below)) return nullptr;
    const auto its = std::ranges::find_if(coats_, [&](const auto& one) { return one.second.get() == &coat; });
    const MetalKey key{&coat, key_of(above), key_of(below)};
    auto& made = over_metals_[key];
    if (!made && its == coats_.end())  // somebody else's
        made = std::make_shared<const OverMetal>(OverMetal{nullptr, CoatedMetal(coat, above, below)});
    else if (!made)
        made = all_over_metals().get(key, [&] {
            return std::make_shared<const OverMetal>(OverMetal{its->second, CoatedMetal(coat, above, below)});
        });
    return &made->metal;
}

}  // namespace lightnet
