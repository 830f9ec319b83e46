// Tells a person what a graph can be made of.
#pragma once

#include <string>

#include "core/network/graph/kind.hpp"

namespace lightnet {

/// All kinds, one line each.
std::string describe(const Registry& registry);
/// One kind: what it does, its inputs, and each parameter with type, unit, default, range and help.
std::string describe(const Kind& kind);

}  // namespace lightnet
