#include "lua/hosts_script.hpp"

#include <lua_any.hpp>

#include <utility>

#include "core/base/in_quotes.hpp"
#include "core/base/printable.hpp"
#include "core/network/graph/json.hpp"
#include "lua/guarded.hpp"

namespace lightnet::lua {
namespace {

constexpr std::size_t most_hosts = 10000;

}  // namespace

HostsScript::HostsScript(Sandbox& sandbox, const LuaOptions& options)
    : Globals(sandbox, options.constants), hosts_{sandbox.file(), {}} {
    offer("place", &HostsScript::place);
    offer("strategy", &HostsScript::strategy);
    offer("layout", &HostsScript::layout);
}

int HostsScript::call(lua_State*, Unknown& callee) {
    callee.taken = true;
    throw Error(
        "a hosts file knows only place \"tcp://host:port\" { node = replicas } (\"here\": this process), strategy and "
        "layout, not " +
        in_quotes(callee.name));
}

// strategy = "name": for all nodes. The name stays what it was, so that strategy { … } may follow.
void HostsScript::assigned(lua_State* L, const std::string& name) {
    const bool strategies = name == "strategy";
    if (!strategies && name != "layout") return;
    const auto where = sandbox_.caller();
    if (lua_type(L, -1) == LUA_TSTRING) remember(lua_tostring(L, -1));
    if (lua_type(L, -1) == LUA_TSTRING && is_utf8(lua_tostring(L, -1)))
        (strategies ? hosts_.strategies : hosts_.layouts).push_back({"", lua_tostring(L, -1), where});
    else
        complain(where, name + " is called by name: " + name + " = " + (strategies ? "\"fastest\"" : "\"sharded\""));
    lua_pushlightuserdata(L, this);
    lua_pushcclosure(L, strategies ? &HostsScript::strategy : &HostsScript::layout, 1);
    lua_replace(L, -2);
}

// strategy { node = "name" }
int HostsScript::strategy(lua_State* L) {
    return guarded(L, [&] {
        auto& script = *static_cast<HostsScript*>(lua_touserdata(L, lua_upvalueindex(1)));
        script.take_choices(L, "strategy", "nodes and strategies", "fastest", script.hosts_.strategies);
        return 0;
    });
}

// layout { node = "name" }
int HostsScript::layout(lua_State* L) {
    return guarded(L, [&] {
        auto& script = *static_cast<HostsScript*>(lua_touserdata(L, lua_upvalueindex(1)));
        script.take_choices(L, "layout", "nodes and layouts", "sharded", script.hosts_.layouts);
        return 0;
    });
}

void HostsScript::take_choices(lua_State* L, const std::string& word, const std::string& what,
                               const std::string& example, std::vector<ChoiceEntry>& choices) {
    if (lua_gettop(L) != 1 || !lua_istable(L, 1))
        throw Error(word + " takes a table, " + word + " { node = \"name\" }, or is one for all: " + word +
                    " = \"name\"");
    const auto where = sandbox_.caller();
    std::map<std::string, std::string> named;  // in an order that does not change
    for (lua_pushnil(L); lua_next(L, 1); lua_settop(L, 2)) {
        if (lua_type(L, 2) != LUA_TSTRING || lua_type(L, 3) != LUA_TSTRING || !is_utf8(lua_tostring(L, 2)) ||
            !is_utf8(lua_tostring(L, 3)))
            complain(where, word + ": " + what + " go by name: " + word + " { node = \"" + example + "\" }");
        else
            named.emplace(lua_tostring(L, 2), lua_tostring(L, 3));
    }
    for (auto& [node, name] : named) {
        remember(node + name);
        choices.push_back({node, std::move(name), where});
    }
}

// place "endpoint" gives the function that takes the table.
int HostsScript::place(lua_State* L) {
    return guarded(L, [&] {
        auto& script = *static_cast<HostsScript*>(lua_touserdata(L, lua_upvalueindex(1)));
        if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TSTRING || !is_utf8(lua_tostring(L, 1)))
            throw Error("place takes the host first: place \"tcp://host:port\" { node = replicas }");
        auto& hosts = script.hosts_.hosts;
        if (hosts.size() >= most_hosts) throw Error("too many hosts");
        script.remember(lua_tostring(L, 1));
        hosts.push_back({lua_tostring(L, 1), {}, 0, script.sandbox_.caller()});
        lua_pushvalue(L, lua_upvalueindex(1));
        lua_pushinteger(L, static_cast<lua_Integer>(hosts.size() - 1));
        lua_pushcclosure(L, &HostsScript::fill, 2);
        return 1;
    });
}

int HostsScript::fill(lua_State* L) {
    return guarded(L, [&] {
        auto& script = *static_cast<HostsScript*>(lua_touserdata(L, lua_upvalueindex(1)));
        auto& entry = script.hosts_.hosts.at(static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(2))));
        if (lua_gettop(L) != 1 || !lua_istable(L, 1))
            throw Error("place " + in_quotes(entry.endpoint) + " takes a table: { node = replicas }");
        script.take_replicas(L, entry);
        return 0;
    });
}

void HostsScript::take_replicas(lua_State* L, HostEntry& entry) {
    const std::string who = "place " + in_quotes(entry.endpoint) + ": ";
    for (lua_pushnil(L); lua_next(L, 1); lua_settop(L, 2)) {
        if (lua_type(L, 2) != LUA_TSTRING || !is_utf8(lua_tostring(L, 2))) {
            complain(entry.where, who + "nodes go by name: { node = replicas }");
            continue;
        }
        const std::string name = lua_tostring(L, 2);
        if (name == "key" && lua_type(L, 3) == LUA_TSTRING && is_utf8(lua_tostring(L, 3))) {
            entry.key = lua_tostring(L, 3);
            remember(entry.key);
            continue;
        }
        int integral = 0;
        const lua_Integer count = lua_type(L, 3) == LUA_TNUMBER ? lua_tointegerx(L, 3, &integral) : 0;
        if (!integral || count < 0 || count > 1'000'000)
            complain(entry.where, who + "how many " + in_quotes(name) + "? A positive integer is wanted");
        else if (name == "places")
            entry.places = static_cast<int>(count);
        else {
            if (!entry.replicas.contains(name)) remember(name);
            entry.replicas[name] = static_cast<int>(count);
        }
    }
}

Hosts HostsScript::finish() {
    Globals::finish({"place", "strategy", "layout"});
    return std::move(hosts_);
}

}  // namespace lightnet::lua
