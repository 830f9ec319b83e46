// Lets C++ functions that throw be called from Lua.
#pragma once

#include <functional>

struct lua_State;

namespace lightnet::lua {

/// Runs `function` for Lua: an exception becomes an error of the line that called. Lua's own errors, which are
/// exceptions of another kind, pass.
int guarded(lua_State* L, const std::function<int()>& function);

}  // namespace lightnet::lua
