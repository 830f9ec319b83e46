// A value between values: what graphs say of things that change from frame to frame.
#pragma once

struct lua_State;

namespace lightnet::lua {

/// `keys { [1] = 0, [24] = 1 }`: the value at `frame`, or of `keys(table, x)` at x. Between two keys numbers, and
/// tables of them, lie on a straight line, or with `smooth = true` on a curve through all keys; with `hold = true`, as
/// other values always, they stay until the next key. Before the first key and after the last all stand still. A
/// function for Lua.
int keys(lua_State* L);

}  // namespace lightnet::lua
