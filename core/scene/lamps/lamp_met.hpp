// Lamps that rays have come to.
#pragma once

#include <cstdint>

#include "core/scene/lamps/lit_point.hpp"

namespace lightnet {

/// A point of a lamp that a ray from a surface has come to: what is needed to know how likely sampling lights there
/// would have found it.
struct LampMet {
    LitPoint from;
    std::uint32_t lamp = 0;
    float density = 0;  // per steradian, if that lamp is chosen
};

}  // namespace lightnet
