// Terms by which a place gives questions of a node that it holds to others which hold it, too.
#pragma once

#include <algorithm>
#include <cstddef>

#include "core/run/schedule/replica_order.hpp"
#include "core/run/schedule/routing_port.hpp"

namespace lightnet::relief {

inline constexpr double enough = 0.02;  // seconds of work: helpers are asked again long before they have done it
inline constexpr std::size_t least_bundle = 64;  // questions, and as many as long as nobody knows how long they take
inline constexpr double worth_waiting = 2;       // times as long as this place would need for all that waits
inline constexpr double own_piece = 5e-4;        // seconds that this place takes for them at once
inline constexpr std::size_t most_own = 4;       // such pieces at the same time, of nodes that ask on
inline constexpr double fades_in = 5;  // seconds, after which idle helpers are tried again, however slow they were

/// Should so many of the questions that wait go to a helper? They get bundles as long as they answer one soon; of
/// questions so dear that a bundle can't be small, one where they have nothing to do. As a rule this place has
/// something else to do meanwhile: so it may take them a little longer than this place alone would need for all that
/// waits. `each`: seconds that one takes here; 0: not known.
// DECISIONS: relief-by-the-idle
inline bool may_go(const ReplicaOrder& order, std::size_t questions, std::size_t waiting, double each) {
    const auto soonest = order.soonest(questions);
    if (!soonest) return false;
    const bool dear = each * least_bundle > enough;
    if (*soonest > enough && !(dear && order.has_idle_place(*order.first_open()))) return false;
    return each <= 0 || *soonest <= worth_waiting * each * static_cast<double>(waiting);
}

/// Questions that this place takes at once. `each`: seconds of one, 0: not known. Those of a node that asks on stay
/// together, as others could do what they lead to; but helpers keep their part of all that waits.
inline std::size_t piece_of_own(double each, std::size_t waiting, std::size_t helpers, std::size_t most, bool asks_on) {
    if (each <= 0) return least_bundle;
    const auto quick = static_cast<std::size_t>(std::min(own_piece / each, 1e9));
    const std::size_t together = asks_on ? std::min(RoutingPort::worth_sharing, waiting / (helpers + 1)) : 1;
    return std::clamp<std::size_t>(std::max(quick, together), 1, most);
}

}  // namespace lightnet::relief
