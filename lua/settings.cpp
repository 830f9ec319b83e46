#include "lua/settings.hpp"

#include <lua_any.hpp>

#include <algorithm>
#include <tuple>

#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/words_of.hpp"
#include "core/network/graph/json.hpp"
#include "core/network/graph/value.hpp"
#include "lua/child.hpp"
#include "lua/files.hpp"
#include "lua/sandbox.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_memory = std::size_t{64} << 20;
constexpr const char* lines_key = "lightnet.lines";  // of the registry: name → line

int keep_line(lua_State* L) {  // globals, name, value
    lua_getfield(L, LUA_REGISTRYINDEX, lines_key);
    lua_pushvalue(L, 2);
    lua_pushinteger(L, lua::Sandbox::of(L).caller().line);
    lua_rawset(L, -3);
    lua_pop(L, 1);
    lua_rawset(L, 1);
    return 0;
}

// What the file gives goes into a table of its own, behind which the libraries stand.
void open_table(lua_State* L) {
    lua_newtable(L);
    lua_setfield(L, LUA_REGISTRYINDEX, lines_key);
    lua_newtable(L);
    lua_newtable(L);
    lua_rawgeti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, keep_line);
    lua_setfield(L, -2, "__newindex");
    lua_setmetatable(L, -2);
    lua_rawseti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
}

std::string text_at(lua_State* L, int index) {
    switch (lua_type(L, index)) {
        case LUA_TBOOLEAN:
            return lua_toboolean(L, index) ? "true" : "false";
        case LUA_TNUMBER:
            return number_text(lua_tonumber(L, index));
        case LUA_TSTRING:
            return lua_tostring(L, index);
        default:
            return {};
    }
}

struct Taken {
    std::vector<SettingLine> lines;
    std::vector<Problem> problems;
};

// Of the table on top of the stack.
void take_table(lua_State* L, const std::string& verb, const SourceLine& where, Taken& taken) {
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
        if (lua_type(L, -2) != LUA_TSTRING) {
            taken.problems.push_back({where, "settings go by name: name = value"});
            continue;
        }
        const std::string name = lua_tostring(L, -2);
        SourceLine line = where;
        if (verb.empty()) {
            lua_getfield(L, LUA_REGISTRYINDEX, lines_key);
            lua_getfield(L, -1, name.c_str());
            line.line = static_cast<int>(lua_tointeger(L, -1));
            lua_pop(L, 2);
        }
        if (lua_istable(L, -1) && verb.empty()) {
            take_table(L, name, line, taken);
            continue;
        }
        const auto type = lua_type(L, -1);
        if (type != LUA_TBOOLEAN && type != LUA_TNUMBER && type != LUA_TSTRING)
            taken.problems.push_back({line, "'" + name + "' takes a text, a number or true"});
        else
            taken.lines.push_back({verb, name, text_at(L, -1), line});
    }
}

std::string evaluate_settings(const std::string& file) {
    Taken taken;
    try {
        lua::Sandbox sandbox(file, most_memory);
        open_table(sandbox.state());
        sandbox.run(lua::read_text(file));
        lua_rawgeti(sandbox.state(), LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
        take_table(sandbox.state(), "", {file, 0}, taken);
    } catch (const UserError& error) {
        taken.problems = error.problems();
    } catch (const std::exception& error) {
        taken.problems = {{{file, 0}, words_of(error)}};
    }
    auto lines = JsonTree::list();
    for (const auto& line : taken.lines) lines.push_back({line.verb, line.name, line.value, line.where.line});
    return to_json(taken.problems) + "\n" + to_text(lines);
}

}  // namespace

std::vector<SettingLine> load_settings(const std::string& file) {
    std::string text;
    try {
        text = lua::in_child({}, [&] { return evaluate_settings(file); });
    } catch (const Error& error) {
        throw UserError({file, 0}, error.what());
    }
    const auto end = text.find('\n');
    if (auto problems = problems_from_json(std::string_view(text).substr(0, end)); !problems.empty())
        throw UserError(std::move(problems));
    std::vector<SettingLine> lines;
    const Json read = parse_json(std::string_view(text).substr(end + 1));
    for (const auto& line : read.list()) {
        const auto& part = line.list(4);
        lines.push_back({part[0].text(), part[1].text(), part[2].text(), {file, static_cast<int>(part[3].number())}});
    }
    std::sort(lines.begin(), lines.end(),
              [](const auto& a, const auto& b) { return std::tie(a.verb, a.name) < std::tie(b.verb, b.name); });
    return lines;
}

}  // namespace lightnet
