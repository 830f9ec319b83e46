// Lets C++ functions that throw be called from Lua. Included by .cpp files only.
#pragma once

#include <lua.hpp>

#include <exception>

namespace lightnet::lua {

/// Runs `function` for Lua: an exception becomes an error of the line that called. Lua's own errors, which are
/// exceptions of another kind, pass.
template <class Function>
int guarded(lua_State* L, Function function) {
    try {
        return function();
    } catch (const std::exception& error) {
        luaL_where(L, 1);
        lua_pushstring(L, error.what());
    }
    lua_concat(L, 2);
    return lua_error(L);
}

}  // namespace lightnet::lua
