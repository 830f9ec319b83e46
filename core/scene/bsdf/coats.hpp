// The coats of a scene: each kind is worked out once, however many materials have it.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/scene/bsdf/coat.hpp"
#include "core/scene/bsdf/coated_metal.hpp"

namespace lightnet {

/// Keeps what it made as long as it lives itself. Not for several threads at once; what it gives is for any.
class Coats {
public:
    /// Roughnesses: none where they change over a surface.
    const Coat& coat(float eta, const std::optional<Ggx>& facets, CoatLayer layer);
    /// Null where both layers are smooth, and nothing has to be known.
    const CoatedMetal* over_metal(const Coat& coat, const std::optional<Ggx>& above, const std::optional<Ggx>& below);

private:
    std::map<std::array<float, 6>, std::unique_ptr<const Coat>> coats_;
    std::map<std::pair<const Coat*, std::array<float, 6>>, std::unique_ptr<const CoatedMetal>> over_metals_;
};

}  // namespace lightnet
