// Takes a function out of a file, so that it can go to hosts as text.
#pragma once

#include <string>

struct lua_State;

namespace lightnet::lua {

/// Of the Lua function on top of the stack, which `text` holds, the text of `file`: a chunk that returns it, with its
/// lines where they are in the file, and before it the constants that it names: numbers, texts, true and false, and
/// tables of such, of those around it and of the table of globals at `globals`. Ends in a comment that names the file.
/// Throws Error: it names what can't be given along, or doesn't stand alone on its lines.
std::string function_source(lua_State* L, int globals, const std::string& file, const std::string& text);

/// The file that such a chunk names; `otherwise`, if it names none.
std::string file_of_source(const std::string& source, const std::string& otherwise);

}  // namespace lightnet::lua
