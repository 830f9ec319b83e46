#include "lua/guarded.hpp"

#include <lua_any.hpp>

#include <exception>
#include <new>

#include "core/base/unwanted.hpp"

namespace lightnet::lua {

int guarded(lua_State* L, const std::function<int()>& function) {
    try {
        return function();
    } catch (const std::bad_alloc&) {
        return luaL_error(L, "not enough memory");
    } catch (const Cancelled&) {  // whoever runs Lua looks whether it is wanted
        return luaL_error(L, "is no longer wanted");
    } catch (const std::exception& error) {
        luaL_where(L, 1);
        lua_pushstring(L, error.what());
    }
    lua_concat(L, 2);
    return lua_error(L);
}

}  // namespace lightnet::lua
