#include "lua/globals.hpp"

#include <lua_any.hpp>

#include <set>
#include <utility>

#include "core/base/suggestion.hpp"
#include "lua/guarded.hpp"

namespace lightnet::lua {
namespace {

constexpr const char* unknown_type = "lightnet.unknown";
constexpr const char* store = "lightnet.globals";  // where the globals really are, in the registry
constexpr const char* owner = "lightnet.owner";
constexpr std::size_t most_remembered = std::size_t{8} << 20;  // bytes of names and the like
constexpr std::size_t bytes_of_entry = 128;                    // about, beside its text

bool push_number(lua_State* L, const std::string& text) {
    return lua_stringtonumber(L, text.c_str()) == text.size() + 1;
}

// Pushes `text` as a value of the type of the value on top of the stack, or, false, nothing.
bool push_like_top(lua_State* L, const std::string& text) {
    switch (lua_type(L, -1)) {
        case LUA_TSTRING:
            lua_pushlstring(L, text.data(), text.size());
            return true;
        case LUA_TNUMBER:
            return push_number(L, text);
        case LUA_TBOOLEAN:
            if (text != "true" && text != "false") return false;
            lua_pushboolean(L, text == "true");
            return true;
        default:
            return false;
    }
}

// Of a value that the file only reads, the look tells the type.
void push_by_look(lua_State* L, const std::string& text) {
    if (text == "true" || text == "false")
        lua_pushboolean(L, text == "true");
    else if (!push_number(L, text))
        lua_pushlstring(L, text.data(), text.size());
}

bool type_of_constants(int type) { return type == LUA_TSTRING || type == LUA_TNUMBER || type == LUA_TBOOLEAN; }

const char* type_in_words(int type) {
    switch (type) {
        case LUA_TSTRING:
            return "a text";
        case LUA_TNUMBER:
            return "a number";
        case LUA_TBOOLEAN:
            return "true or false";
        case LUA_TTABLE:
            return "a table";
        case LUA_TFUNCTION:
            return "a function";
        default:
            return "a node";
    }
}

}  // namespace

Globals::Globals(Sandbox& sandbox, std::map<std::string, std::string> constants)
    : sandbox_(sandbox), L_(sandbox.state()), overrides_(std::move(constants)) {
    for (const auto& [name, text] : overrides_) met_[name] = false;
    install();
}

// Files see an empty table whose every access comes here; what they assign goes into the registry's.
void Globals::install() {
    lua_State* const L = L_;
    lua_pushlightuserdata(L, this);
    lua_setfield(L, LUA_REGISTRYINDEX, owner);

    luaL_newmetatable(L, unknown_type);
    lua_pushliteral(L, "nil");  // so that Lua itself says "attempt to index a nil value (global 'x')"
    lua_setfield(L, -2, "__name");
    lua_pushcfunction(L, &Globals::call_unknown);
    lua_setfield(L, -2, "__call");
    lua_pushboolean(L, 0);
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 1);

    lua_rawgeti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
    lua_setfield(L, LUA_REGISTRYINDEX, store);
    lua_newtable(L);
    lua_newtable(L);
    lua_pushcfunction(L, &Globals::read_global);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, &Globals::write_global);
    lua_setfield(L, -2, "__newindex");
    lua_pushboolean(L, 0);
    lua_setfield(L, -2, "__metatable");
    lua_setmetatable(L, -2);
    lua_rawseti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
}

void Globals::offer(const char* name, int (*function)(lua_State*)) {
    lua_getfield(L_, LUA_REGISTRYINDEX, store);
    lua_pushlightuserdata(L_, this);
    lua_pushcclosure(L_, function, 1);
    lua_setfield(L_, -2, name);
    lua_pop(L_, 1);
}

double Globals::give(const std::string& name, double value) {
    lua_getfield(L_, LUA_REGISTRYINDEX, store);
    const auto given = overrides_.find(name);
    if (given != overrides_.end()) met_[name] = true;
    if (given == overrides_.end() || !push_number(L_, given->second)) {
        if (given != overrides_.end())
            complain({sandbox_.file(), 0}, "-D " + name + "=" + given->second + ": it is a number");
        lua_Integer whole = 0;
        if (lua_numbertointeger(value, &whole) && static_cast<double>(whole) == value)
            lua_pushinteger(L_, whole);  // as one writes it
        else
            lua_pushnumber(L_, value);
    }
    const double is = lua_tonumber(L_, -1);
    lua_setfield(L_, -2, name.c_str());
    lua_pop(L_, 1);
    return is;
}

Globals& Globals::self(lua_State* L) {
    lua_getfield(L, LUA_REGISTRYINDEX, owner);
    auto* const globals = static_cast<Globals*>(lua_touserdata(L, -1));
    lua_pop(L, 1);
    return *globals;
}

int Globals::read_global(lua_State* L) {
    return guarded(L, [&] { return self(L).read(L); });
}
int Globals::write_global(lua_State* L) {
    return guarded(L, [&] { return self(L).write(L); });
}
int Globals::call_unknown(lua_State* L) {
    return guarded(L, [&] {
        Globals& globals = self(L);
        Unknown* const callee = globals.unknown_at(1);
        if (!callee) throw Error("attempt to call what is no name");
        return globals.call(L, *callee);
    });
}

Globals::Unknown* Globals::unknown_at(int index) {
    const auto* number = static_cast<const std::size_t*>(luaL_testudata(L_, index, unknown_type));
    return number ? &unknowns_.at(*number) : nullptr;
}

void Globals::remember(const std::string& text) {
    remembered_ += text.size() + bytes_of_entry;
    if (remembered_ > most_remembered) throw Error("a file has too many names, or too long ones: at most 8 MiB in all");
}

int Globals::read(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const std::string name = lua_tostring(L, 2);
    lua_getfield(L, LUA_REGISTRYINDEX, store);
    lua_pushvalue(L, 2);
    if (lua_rawget(L, -2) != LUA_TNIL) return 1;
    if (const auto constant = overrides_.find(name); constant != overrides_.end()) {
        met_[name] = true;
        push_by_look(L, constant->second);
        return 1;
    }
    remember(name);
    unknowns_.push_back({name, sandbox_.caller(), false});
    auto* number = static_cast<std::size_t*>(lua_newuserdatauv(L, sizeof(std::size_t), 0));
    *number = unknowns_.size() - 1;
    luaL_setmetatable(L, unknown_type);
    return 1;
}

int Globals::write(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) throw Error("a global goes by a name");
    const std::string name = lua_tostring(L, 2);
    if (overrides_.contains(name)) override_constant(L, name);
    if (type_of_constants(lua_type(L, 3)) && !constants_.contains(name)) {
        remember(name);
        constants_.emplace(name, sandbox_.caller());
    }
    assigned(L, name);
    lua_getfield(L, LUA_REGISTRYINDEX, store);
    lua_insert(L, 2);
    lua_rawset(L, 2);
    return 0;
}

// Puts the value of -D in place of the one on top of the stack.
void Globals::override_constant(lua_State* L, const std::string& name) {
    met_[name] = true;
    const int type = lua_type(L, -1);
    if (push_like_top(L, overrides_.at(name))) return lua_replace(L, -2);
    const std::string given = "-D " + name + "=" + overrides_.at(name) + ": the file gives ";
    complain(sandbox_.caller(), given + type_in_words(type) +
                                    (type_of_constants(type) ? ", and so must -D" : ", which -D can't override"));
}

void Globals::finish(const std::vector<std::string>& named) {
    std::vector<std::string> known = named;
    for (const auto& [name, where] : constants_) known.push_back(name);
    std::set<std::pair<std::string, int>> told;
    for (const auto& [name, where, taken] : unknowns_) {
        if (taken || !told.emplace(where.file + ":" + name, where.line).second) continue;
        if (constants_.contains(name))
            complain(where, "'" + name + "' is used before it has a value");
        else
            complain(where, "nothing is called '" + name + "'" + did_you_mean(name, known));
    }
    std::vector<std::string> constants;
    for (const auto& [name, where] : constants_) constants.push_back(name);
    for (const auto& [name, met] : met_)
        if (!met)
            complain({sandbox_.file(), 0},
                     "-D " + name + ": the file has no constant of that name" + did_you_mean(name, constants));
}

}  // namespace lightnet::lua
