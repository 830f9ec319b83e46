// Columns of numbers for Lua: one entry for each question, and arithmetic on all of them at once. Entries never meet,
// so an answer can't depend on other questions of its call; all is single precision by rules of IEEE 754 alone, so bits
// are the same on every host.
#pragma once

#include <cstddef>
#include <functional>

struct lua_State;

namespace lightnet::lua {

/// A userdatum: `width` numbers (1, or 3 of a vector or colour; 2 of a point) for each of `count` questions, the first
/// of all, then the second.
struct ColumnHead {
    std::size_t width = 1, count = 0;

    float* data() { return reinterpret_cast<float*>(this + 1); }
    float* part(std::size_t i) { return data() + i * count; }
};

/// Puts what Lua calls to work with columns (+ - * /, dot, cross, length, normalize, sqrt, abs, floor, min, max, less,
/// where, vec, x, y, z) into the table on top of the stack. `charge` is told how many entries each call goes through.
void open_columns(lua_State* L, void (*charge)(lua_State* L, std::size_t entries));

/// Pushes one that is not filled in.
ColumnHead& push_column(lua_State* L, std::size_t width, std::size_t count);
/// The column there; null: it is something else.
ColumnHead* column_at(lua_State* L, int index);

}  // namespace lightnet::lua
