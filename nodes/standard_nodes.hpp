// The kinds of this room, as main hands them to a Registry.
#pragma once

#include <vector>

#include "core/network/graph/kind.hpp"

namespace lightnet {

/// All kinds of nodes/, in the order of nodes/CMakeLists.txt. Written by CMake from the list there.
std::vector<Kind> standard_nodes();

}  // namespace lightnet
