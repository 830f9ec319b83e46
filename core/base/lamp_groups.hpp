// Groups of lamps, by number and as sets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lightnet {

/// The group of all lamps that no other group names.
inline constexpr std::string_view rest_of_lamps = "rest";
/// With the rest.
inline constexpr std::size_t most_groups = 64;
/// Some of the groups of a scene, a bit each, the first one lowest.
using GroupSet = std::uint64_t;
inline constexpr GroupSet all_groups = ~GroupSet{0};

}  // namespace lightnet
