// Turns what a graph file does into a graph.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "lua/globals.hpp"
#include "lua/load_graph.hpp"

namespace lightnet::lua {

/// What a graph file has `frame`, `fps` and `time` for.
struct GraphTime {
    double frame = 1, fps = 24, time = 0;
    bool own_time = false;  // the file says itself what time it is
    bool followed = false;  // somebody asks how far things move until the next frame
};

/// Makes a node of every `Kind { … }`, and gives it the name of the first global that it is assigned to.
class GraphScript final : public Globals {
public:
    GraphScript(Sandbox& sandbox, const LuaOptions& options);

    /// The nodes, in the order in which they were named. Problems are complete after this.
    Graph finish();
    /// Of which frame they are.
    int frame() const { return static_cast<int>(now_.frame); }

private:
    struct Made {
        Node node;                            // nameless until assigned
        std::vector<std::string> complaints;  // told when the name is known
    };

    void give_time();
    void take_rate(lua_State* L, const std::string& name);
    void place_in_time(Node& scene) const;
    int call(lua_State* L, Unknown& callee) override;
    void assigned(lua_State* L, const std::string& name) override;

    int make_node(lua_State* L, const std::string& kind);
    void take_entries(lua_State* L, Made& made);
    void take_params(lua_State* L, Made& made);
    Value value_at(lua_State* L, int index, int depth);
    Value function_at(lua_State* L, int index);
    Table table_at(lua_State* L, int index, int depth);
    std::string bytes_at(lua_State* L, int index);
    std::string text_at(lua_State* L, int index);
    void count(std::size_t bytes);
    void note(Made& made, const std::string& complaint);
    const std::size_t* node_at(lua_State* L, int index) const;
    void resolve(Value& value) const;

    GraphFrame of_;
    GraphTime now_;
    std::vector<Made> made_;
    std::vector<std::size_t> order_;            // indices into made_, as they were named
    std::map<std::string, std::size_t> named_;  // all names of nodes, second ones too
    std::size_t values_ = 0, bytes_ = 0;        // of all that was taken so far
    std::size_t noted_ = 0;                     // complaints of nodes
};

}  // namespace lightnet::lua
