// The schema of graphs as text for programs: editors, checkers of Lua, scripts.
#pragma once

#include <string>
#include <vector>

#include "core/network/graph/kind.hpp"

namespace lightnet {

/// All kinds, or the one, as JSON: an object by name. Limits that are infinite, and what is not there, are left out.
std::string schema_json(const std::vector<Kind>& kinds);
/// A definition file for the Lua language server (`---@meta`): it then completes kinds and parameters, and explains
/// them.
std::string lua_definitions(const std::vector<Kind>& kinds);
/// A `.luacheckrc` that knows the names that graph and hosts files may use.
std::string luacheck_settings(const std::vector<Kind>& kinds);

}  // namespace lightnet
