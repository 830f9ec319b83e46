// Operators that a graph file has as Lua functions: `Custom { inputs…, light = function(q, ask) … end }`.
#pragma once

#include "core/network/graph/kind.hpp"

namespace lightnet {

/// The kind Custom, for registries of programs.
Kind custom_kind();

}  // namespace lightnet
