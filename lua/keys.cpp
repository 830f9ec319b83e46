#include "lua/keys.hpp"

#include <lua_any.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "lua/guarded.hpp"

namespace lightnet::lua {
namespace {

constexpr const char* usage = "keys takes a table of values by frame, like keys { [1] = 0, [24] = 1 }";
constexpr int keys_table = 1;  // where it is on the stack

enum class Between { line, curve, nothing };

bool flag(lua_State* L, const char* name) {
    lua_getfield(L, keys_table, name);
    const bool set = lua_toboolean(L, -1);
    lua_pop(L, 1);
    return set;
}

/// Where keys are, in order.
std::vector<double> places(lua_State* L) {
    std::vector<double> at;
    for (lua_pushnil(L); lua_next(L, keys_table); lua_pop(L, 1)) {
        if (lua_type(L, -2) == LUA_TNUMBER) {
            at.push_back(lua_tonumber(L, -2));
            continue;
        }
        const std::string name = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : "";
        if (name != "smooth" && name != "hold")
            throw Error("keys go by numbers, beside smooth = true or hold = true, not by " + in_quotes(name));
    }
    if (at.empty()) throw Error(usage);
    std::sort(at.begin(), at.end());
    return at;
}

void push_key(lua_State* L, double at) {
    lua_pushnumber(L, at);
    lua_gettable(L, keys_table);
}

/// Of a number, or a table of them; none: something else. Takes it off the stack.
std::optional<std::vector<double>> numbers(lua_State* L) {
    std::optional<std::vector<double>> found;
    if (lua_type(L, -1) == LUA_TNUMBER) {
        found = {lua_tonumber(L, -1)};
    } else if (lua_istable(L, -1)) {
        found.emplace();
        for (lua_Unsigned i = 1; found && i <= lua_rawlen(L, -1); ++i) {
            lua_rawgeti(L, -1, static_cast<lua_Integer>(i));
            if (lua_type(L, -1) == LUA_TNUMBER)
                found->push_back(lua_tonumber(L, -1));
            else
                found.reset();
            lua_pop(L, 1);
        }
        if (found && found->empty()) found.reset();
    }
    lua_pop(L, 1);
    return found;
}

/// Numbers by keys, with what lies between.
class Curve {
public:
    Curve(std::vector<double> at, std::vector<std::vector<double>> values, Between between)
        : at_(std::move(at)), values_(std::move(values)), between_(between) {}

    /// `i`: the last key that is not after x; there is another behind it.
    double value(std::size_t i, double x, std::size_t part) const {
        const double a = values_[i][part], b = values_[i + 1][part], step = at_[i + 1] - at_[i];
        const double t = (x - at_[i]) / step;
        if (between_ == Between::line) return a + (b - a) * t;
        // Hermite's cubic
        const double u = 1 - t;
        return a * (1 + 2 * t) * u * u + b * (3 - 2 * t) * t * t +
               step * (slope(i, part) * t * u * u - slope(i + 1, part) * t * t * u);
    }

private:
    /// That of the line from the key before to the one behind, as Catmull & Rom 1974 have it.
    double slope(std::size_t i, std::size_t part) const {
        const std::size_t before = i ? i - 1 : 0, behind = std::min(i + 1, at_.size() - 1);
        return (values_[behind][part] - values_[before][part]) / (at_[behind] - at_[before]);
    }

    std::vector<double> at_;
    std::vector<std::vector<double>> values_;
    Between between_;
};

/// None: they are no numbers, and stay until the next key.
std::optional<Curve> curve(lua_State* L, const std::vector<double>& at, Between between) {
    std::vector<std::vector<double>> values;
    for (const double x : at) {
        push_key(L, x);
        auto found = numbers(L);
        if (!found) return std::nullopt;
        if (!values.empty() && found->size() != values.front().size())
            throw Error("keys: all values must have as many numbers");
        values.push_back(*std::move(found));
    }
    return Curve(at, std::move(values), between);
}

int push_value(lua_State* L, const std::vector<double>& at, double x, Between between) {
    const auto behind = std::upper_bound(at.begin(), at.end(), x);
    const auto last = static_cast<std::size_t>(behind == at.begin() ? 0 : behind - at.begin() - 1);
    const bool at_key = behind == at.begin() || behind == at.end() || x == at[last];
    const auto values = between == Between::nothing ? std::nullopt : curve(L, at, between);
    push_key(L, at[last]);
    if (at_key || !values) return 1;
    if (lua_type(L, -1) == LUA_TNUMBER) {
        lua_pushnumber(L, values->value(last, x, 0));
        return 1;
    }
    const auto size = static_cast<int>(lua_rawlen(L, -1));
    lua_createtable(L, size, 0);
    for (int part = 0; part < size; ++part) {
        lua_pushnumber(L, values->value(last, x, static_cast<std::size_t>(part)));
        lua_rawseti(L, -2, part + 1);
    }
    return 1;
}

}  // namespace

int keys(lua_State* L) {
    return guarded(L, [&] {
        if (!lua_istable(L, keys_table) || lua_gettop(L) > 2) throw Error(usage);
        if (lua_gettop(L) == 1) lua_getglobal(L, "frame");
        if (lua_type(L, 2) != LUA_TNUMBER) throw Error("keys: where to look is a number, like keys({ … }, time)");
        const Between between = flag(L, "hold") ? Between::nothing : flag(L, "smooth") ? Between::curve : Between::line;
        return push_value(L, places(L), lua_tonumber(L, 2), between);
    });
}

}  // namespace lightnet::lua
