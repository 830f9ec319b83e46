#include "lua/function_source.hpp"

#include <fmt/format.h>
#include <lua_any.hpp>

#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include "core/base/error.hpp"

namespace lightnet::lua {
namespace {

constexpr int most_nested = 4;  // of tables in tables
constexpr std::size_t most_constants = 150;
constexpr std::size_t most_constant_bytes = 65536;
constexpr std::string_view file_mark = "\n--@";

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// The lines [first, last] of a text, from 1.
std::string_view lines_of(std::string_view text, int first, int last) {
    std::size_t begin = 0;
    for (int line = 1; line < first; ++line) begin = text.find('\n', begin) + 1;
    std::size_t end = begin;
    for (int line = first; line <= last; ++line) {
        const auto next = text.find('\n', end);
        end = next == std::string_view::npos ? text.size() : next + 1;
    }
    return text.substr(begin, end - begin);
}

bool compiles(lua_State* L, const std::string& text) {
    const bool good = luaL_loadbufferx(L, text.data(), text.size(), "=", "t") == LUA_OK;
    lua_pop(L, 1);
    return good;
}

// Where words are in a line, names and numbers being words.
std::set<std::string> words_of(std::string_view text) {
    std::set<std::string> words;
    for (std::size_t i = 0; i < text.size();) {
        if (!is_word(text[i])) {
            ++i;
            continue;
        }
        const std::size_t begin = i;
        while (i < text.size() && is_word(text[i])) ++i;
        if (!std::isdigit(static_cast<unsigned char>(text[begin]))) words.emplace(text.substr(begin, i - begin));
    }
    return words;
}

// From the word `function` to its `end`: the first one behind which the text is a whole function.
std::string cut_out(lua_State* L, std::string_view lines) {
    const auto first_line = lines.substr(0, lines.find('\n'));
    constexpr std::string_view word = "function";
    const auto begin = first_line.find(word);
    if (begin == std::string_view::npos || first_line.find(word, begin + 1) != std::string_view::npos)
        throw Error("is a function that shares its first line with another: give it a line of its own");
    const auto text = lines.substr(begin);
    const auto last_line =
        text.rfind('\n', text.size() - 2) == std::string_view::npos || text.find('\n') >= text.size() - 1
            ? 0
            : text.rfind('\n', text.size() - 2) + 1;
    for (auto at = text.find("end", last_line); at != std::string_view::npos; at = text.find("end", at + 1)) {
        const std::string whole = "return " + std::string(text.substr(0, at + 3));
        if (compiles(L, whole)) return whole;
    }
    throw Error("is a function whose end is not found");
}

std::string quoted_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (std::isalnum(static_cast<unsigned char>(c)) || c == ' ' || c == '_')
            out += c;
        else
            out += fmt::format("\\{:03}", static_cast<unsigned char>(c));
    }
    return out + "\"";
}

// As Lua writes it; "": it can't be given along.
std::string literal(lua_State* L, int index, int depth) {
    switch (lua_type(L, index)) {
        case LUA_TBOOLEAN:
            return lua_toboolean(L, index) ? "true" : "false";
        case LUA_TNUMBER: {
            if (lua_isinteger(L, index)) return std::to_string(lua_tointeger(L, index));
            const double number = lua_tonumber(L, index);
            if (std::isnan(number)) return "(0/0)";
            if (std::isinf(number)) return number > 0 ? "(1/0)" : "(-1/0)";
            return fmt::format("{:.17g}", number) +
                   (number == std::floor(number) && std::fabs(number) < 1e15 ? ".0" : "");
        }
        case LUA_TSTRING: {
            std::size_t size = 0;
            const char* const text = lua_tolstring(L, index, &size);
            return quoted_text({text, size});
        }
        case LUA_TTABLE:
            break;
        default:
            return {};
    }
    if (depth == most_nested) return {};
    std::map<std::string, std::string> entries;  // in an order of its own
    const int table = lua_absindex(L, index);
    for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
        const auto key = literal(L, -2, most_nested), value = literal(L, -1, depth + 1);
        if (key.empty() || value.empty()) {
            lua_pop(L, 2);
            return {};
        }
        entries["[" + key + "]"] = value;
    }
    std::string text = "{";
    for (const auto& [key, value] : entries) text += key + "=" + value + ",";
    return text + "}";
}

// Constants that the function takes from around it, or from the globals, by name. The function is on top of the stack.
std::map<std::string, std::string> constants_of(lua_State* L, int globals, const std::set<std::string>& words) {
    std::map<std::string, std::string> constants;
    luaL_checkstack(L, 16, "constants");
    const int function = lua_gettop(L);
    for (const auto& word : words) {
        lua_getfield(L, globals, word.c_str());
        if (auto text = literal(L, -1, 0); !text.empty()) constants[word] = std::move(text);
        lua_pop(L, 1);
    }
    for (int i = 1; const char* const name = lua_getupvalue(L, function, i); ++i) {
        const std::string word = name;
        const auto text = literal(L, -1, 0);
        const char* const type = luaL_typename(L, -1);
        const bool nil = lua_isnil(L, -1);
        lua_pop(L, 1);
        if (word == "_ENV" || nil) continue;
        if (text.empty())
            throw Error("is a function that takes '" + word + "' from outside, a " + type +
                        ": only numbers, texts and tables of them go to hosts along with it; define it inside");
        constants[word] = text;
    }
    return constants;
}

}  // namespace

std::string function_source(lua_State* L, int globals, const std::string& file, const std::string& text) {
    lua_Debug info{};
    lua_pushvalue(L, -1);
    lua_getinfo(L, ">S", &info);
    if (info.linedefined <= 0) throw Error("is a function that is not written in Lua");
    const auto lines = lines_of(text, info.linedefined, info.lastlinedefined);
    const std::string function = cut_out(L, lines);
    std::string chunk;
    const auto constants = constants_of(L, lua_absindex(L, globals), words_of(function));
    for (const auto& [name, value] : constants) chunk += "local " + name + "=" + value + ";";
    if (constants.size() > most_constants || chunk.size() > most_constant_bytes)
        throw Error("is a function that takes too many constants along");
    return chunk + std::string(static_cast<std::size_t>(info.linedefined - 1), '\n') + function +
           std::string(file_mark) + file;
}

std::string file_of_source(const std::string& source, const std::string& otherwise) {
    const auto mark = source.rfind(file_mark);
    return mark == std::string::npos ? otherwise : source.substr(mark + file_mark.size());
}

}  // namespace lightnet::lua
