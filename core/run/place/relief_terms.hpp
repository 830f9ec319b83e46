// Terms by which a place gives questions of a node that it holds to others which hold it, too.
#pragma once

#include <cstddef>

namespace lightnet::relief {

inline constexpr double enough = 0.02;  // seconds of work: helpers are asked again long before they have done it
inline constexpr std::size_t least_bundle = 64;  // questions, and as many as long as nobody knows how long they take
inline constexpr double worth_waiting = 2;       // times as long as this place would need for all that waits
inline constexpr double own_piece = 5e-4;        // seconds that this place takes for them at once
inline constexpr std::size_t most_own = 4;       // such pieces at the same time, of nodes that ask on

}  // namespace lightnet::relief
