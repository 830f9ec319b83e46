// A node at one place.
#pragma once

#include <compare>
#include <cstddef>

#include "core/network/graph/plan.hpp"

namespace lightnet {

/// A place may hold several nodes that stand for the sectors of one.
struct NodeCopy {
    PlaceAt place;
    std::size_t node;
    friend auto operator<=>(const NodeCopy&, const NodeCopy&) = default;
};

}  // namespace lightnet
