// The coats of a scene: each kind is worked out once, however many materials have it, and however many scenes that are
// there at the same time.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>

#include "core/base/shared_work.hpp"
#include "core/scene/bsdf/coat.hpp"
#include "core/scene/bsdf/coated_metal.hpp"

namespace lightnet {

/// Keeps what it made as long as it lives itself. Not for several threads at once; what it gives is for any.
class Coats {
public:
    const Coat& coat(float eta, const FacetRange& facets, CoatLayer layer);
    /// Null where both layers are smooth, and nothing has to be known.
    const CoatedMetal* over_metal(const Coat& coat, const FacetRange& above, const FacetRange& below);

private:
    using FacetKey = std::array<float, 5>;
    using CoatKey = std::tuple<float, FacetKey, float, std::uint32_t>;
    using MetalKey = std::tuple<const Coat*, FacetKey, FacetKey>;
    struct OverMetal;  // with the coat that it looks at
    static SharedWork<CoatKey, Coat>& all_coats();
    static SharedWork<MetalKey, OverMetal>& all_over_metals();

    std::map<CoatKey, std::shared_ptr<const Coat>> coats_;
    std::map<MetalKey, std::shared_ptr<const OverMetal>> over_metals_;
};

}  // namespace lightnet
