// Names of places in messages.
#pragma once

#include <set>

#include "core/base/math/random.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {

/// In place of an index: whichever its host chooses. Never in a plan.
inline constexpr std::uint32_t any_place = 0xffffffff;

/// A short name for a place, the same on every host. Never 0, which stands for the launcher.
inline std::uint64_t name_of(const PlaceAt& place) { return child(key_of(place.host), 0, place.index) | 1; }

/// The names of the places that are gone in the later of two plans. One that the earlier doesn't have yet is not gone.
inline std::set<std::uint64_t> lost_names(const Plan& before, const Plan& after) {
    std::set<std::uint64_t> lost;
    for (const auto& place : before.places) lost.insert(name_of(place));
    for (const auto& place : after.places) lost.erase(name_of(place));
    return lost;
}

}  // namespace lightnet
