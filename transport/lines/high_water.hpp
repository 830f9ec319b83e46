// The number of messages that may wait between two who keep the rules of credit.
#pragma once

#include <cstddef>

namespace lightnet {

/// Sizes that were agreed on (flow control by credit) never fill a queue of this many messages; if one is full,
/// something is wrong, and counted.
inline constexpr int high_water_mark = 4096;
/// May a socket that connects have refused because its queue is full, with so many messages on their way? If not, its
/// peer is gone for the moment; it does not tell which.
inline bool may_be_full(std::size_t under_way) { return under_way >= std::size_t{high_water_mark} / 2; }

}  // namespace lightnet
