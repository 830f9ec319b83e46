// A short name for a place, the same on every host.
#pragma once

#include "core/base/math/random.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {

/// Never 0, which stands for the launcher.
inline std::uint64_t name_of(const PlaceAt& place) { return child(key_of(place.host), 0, place.index) | 1; }

}  // namespace lightnet
