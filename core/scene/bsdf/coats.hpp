// The coats of a scene: each kind is worked out once, however many materials have it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>

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
    std::map<std::tuple<float, FacetKey, float, std::uint32_t>, std::unique_ptr<const Coat>> coats_;
    std::map<std::tuple<const Coat*, FacetKey, FacetKey>, std::unique_ptr<const CoatedMetal>> over_metals_;
};

}  // namespace lightnet
