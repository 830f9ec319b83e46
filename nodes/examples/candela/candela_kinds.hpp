// The classes of Candela as kinds of nodes.
#pragma once

#include <vector>

#include "core/network/graph/kind.hpp"

namespace lightnet {

std::vector<Kind> candela_kinds();

}  // namespace lightnet
