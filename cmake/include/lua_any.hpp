// Lua compiled as C++, whose errors are exceptions. Debian 12's exports names of C, Debian 13's those of C++, which the
// usual <lua.hpp> does not declare.
#pragma once

#if LIGHTNET_LUA_NAMES_OF_C
#include <lua.hpp>
#else
#include <lua.h>
//
#include <lauxlib.h>
#include <lualib.h>
#endif
