// Turns what a hosts file does into hosts.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/network/graph/hosts.hpp"
#include "lua/globals.hpp"

namespace lightnet::lua {

/// Makes an entry of every `place "tcp://host:port" { … }`, of `strategy = "name"`, of each in
/// `strategy { node = "name" }`, and likewise of `layout`.
class HostsScript final : public Globals {
public:
    HostsScript(Sandbox& sandbox, const LuaOptions& options);

    /// The entries, in the order of the file. Problems are complete after this.
    Hosts finish();

private:
    int call(lua_State* L, Unknown& callee) override;
    void assigned(lua_State* L, const std::string& name) override;

    static int place(lua_State* L);
    static int fill(lua_State* L);
    static int strategy(lua_State* L);
    static int layout(lua_State* L);
    void take_replicas(lua_State* L, HostEntry& entry);
    void take_choices(lua_State* L, const std::string& word, const std::string& what, const std::string& example,
                      std::vector<ChoiceEntry>& choices);

    Hosts hosts_;
};

}  // namespace lightnet::lua
