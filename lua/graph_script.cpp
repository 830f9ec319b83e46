#include "lua/graph_script.hpp"

#include <lua_any.hpp>

#include <cctype>
#include <utility>

#include "core/base/frame_name.hpp"
#include "core/base/in_quotes.hpp"
#include "core/base/printable.hpp"
#include "core/base/suggestion.hpp"
#include "core/network/graph/frames_beside.hpp"
#include "core/network/graph/json.hpp"
#include "lua/keys.hpp"

namespace lightnet::lua {
namespace {

constexpr const char* node_type = "lightnet.node";
constexpr std::size_t most_values = 200000;                    // numbers, texts and tables of a whole graph
constexpr std::size_t most_text_bytes = std::size_t{4} << 20;  // of its texts
constexpr int most_depth = 12;                                 // of tables in tables

// Until all nodes have their names, a reference goes by the node's number; no name of a file's can begin like this.
constexpr char by_number = '\x01';

// What --frames says stands before what the file says.
std::map<std::string, std::string> with_frame_number(const LuaOptions& options) {
    auto constants = options.constants;
    if (options.frame.asked) constants["frame"] = std::to_string(options.frame.number);
    return constants;
}

}  // namespace

GraphScript::GraphScript(Sandbox& sandbox, const LuaOptions& options)
    : Globals(sandbox, with_frame_number(options)), of_(options.frame) {
    now_.frame = give("frame", of_.number);
    give("frames", of_.count);
    now_.fps = give("fps", now_.fps);
    give_time();
    offer("keys", &keys);
    luaL_newmetatable(L_, node_type);
    lua_pushliteral(L_, "node");
    lua_setfield(L_, -2, "__name");
    lua_pushboolean(L_, 0);
    lua_setfield(L_, -2, "__metatable");
    lua_pop(L_, 1);
}

// The first frame begins at 0.
// DECISIONS: frames-alone-are-frames
void GraphScript::give_time() {
    if (!now_.own_time) now_.time = give("time", (now_.frame - 1) / now_.fps);
}

// The value on top of the stack is what the file says of frames.
void GraphScript::take_rate(lua_State* L, const std::string& name) {
    if (lua_type(L, -1) != LUA_TNUMBER) return;
    const double value = lua_tonumber(L, -1);
    if (name == "time") now_.own_time = true, now_.time = value;
    if (name == "frame") now_.frame = value;
    if (name == "fps" && !(value > 0)) return complain(sandbox_.caller(), "'fps', frames per second, must be above 0");
    if (name == "fps") now_.fps = value;
    give_time();
}

// Where a file moves and the graph does not say when, it is the time of the frame.
void GraphScript::place_in_time(Node& scene) const {
    for (auto& entry : scene.entries)
        if (auto* file = std::get_if<std::string>(&entry.data)) *file = with_frame(*file, static_cast<int>(now_.frame));
    const bool looks_ahead = now_.followed || scene.params.contains("shutter");
    if (of_.asked || looks_ahead) scene.params.try_emplace("time", Value{now_.time});
    if (looks_ahead) scene.params.try_emplace("fps", Value{now_.fps});
}

const std::size_t* GraphScript::node_at(lua_State* L, int index) const {
    return static_cast<const std::size_t*>(luaL_testudata(L, index, node_type));
}

int GraphScript::call(lua_State* L, Unknown& callee) {
    callee.taken = true;
    const std::string name = callee.name;
    if (lua_gettop(L) == 2 && lua_istable(L, 2)) return make_node(L, name);
    if (std::isupper(static_cast<unsigned char>(name[0])))
        throw Error(name, "takes one table: " + name + " { inputs, key = value }");
    throw Error("there is no function called " + in_quotes(name));
}

int GraphScript::make_node(lua_State* L, const std::string& kind) {
    count(kind.size());
    if (made_.size() >= most_nodes) throw Error("a graph has at most " + std::to_string(most_nodes) + " nodes");
    Made made;
    made.node.kind = kind;
    made.node.where = sandbox_.caller();
    take_entries(L, made);
    take_params(L, made);
    made_.push_back(std::move(made));
    auto* number = static_cast<std::size_t*>(lua_newuserdatauv(L, sizeof(std::size_t), 0));
    *number = made_.size() - 1;
    luaL_setmetatable(L, node_type);
    return 1;
}

void GraphScript::take_entries(lua_State* L, Made& made) {
    const auto size = lua_rawlen(L, 2);
    for (lua_Unsigned i = 1; i <= size; ++i) {
        if (lua_rawgeti(L, 2, static_cast<lua_Integer>(i)) == LUA_TNIL)
            note(made, "entry " + std::to_string(i) + " is nil");
        else
            try {
                made.node.entries.push_back(value_at(L, -1, 0));
            } catch (const UserError& error) {
                note(made, "entry " + std::to_string(i) + " " + error.what());
            }
        lua_settop(L, 2);
    }
}

void GraphScript::take_params(lua_State* L, Made& made) {
    const auto size = static_cast<lua_Integer>(lua_rawlen(L, 2));
    for (lua_pushnil(L); lua_next(L, 2); lua_settop(L, 3)) {
        if (lua_isinteger(L, 3) && lua_tointeger(L, 3) >= 1 && lua_tointeger(L, 3) <= size) continue;
        if (lua_isinteger(L, 3)) {
            note(made, "an entry before the one at " + std::to_string(lua_tointeger(L, 3)) + " is nil");
        } else if (lua_type(L, 3) != LUA_TSTRING) {
            note(made, "a parameter goes by a name");
        } else
            try {
                const std::string key = text_at(L, 3);
                const bool operates = made.node.kind == "Custom" && key == "light" && lua_isfunction(L, 4);
                made.node.params.emplace(key, operates ? function_at(L, 4) : value_at(L, 4, 0));
            } catch (const UserError& error) {
                note(made, "parameter " + in_quotes(lua_tostring(L, 3)) + " " + error.what());
            }
    }
}

// Throws UserError, whose place says nothing, when the value can't stand in a graph.
Value GraphScript::value_at(lua_State* L, int index, int depth) {
    count(0);
    switch (lua_type(L, index)) {
        case LUA_TBOOLEAN:
            return {lua_toboolean(L, index) != 0};
        case LUA_TNUMBER:
            return {static_cast<double>(lua_tonumber(L, index))};
        case LUA_TSTRING:
            return {bytes_at(L, index)};
        case LUA_TTABLE:
            return {table_at(L, lua_absindex(L, index), depth + 1)};
        default:
            break;
    }
    if (const auto* node = node_at(L, index)) return {NodeRef{by_number + std::to_string(*node)}};
    if (Unknown* const later = unknown_at(index)) {
        later->taken = true;
        return {NodeRef{later->name}};
    }
    throw UserError({}, std::string("is a ") + luaL_typename(L, index));
}

// As text, which is what travels.
Value GraphScript::function_at(lua_State* L, int index) {
    if (lua_iscfunction(L, index)) throw UserError({}, "is a function that is not written in Lua");
    std::string source = sandbox_.source_of_function(L, index);
    count(source.size());
    return {std::move(source)};
}

Table GraphScript::table_at(lua_State* L, int index, int depth) {
    if (depth > most_depth) throw UserError({}, "has tables in tables without end");
    luaL_checkstack(L, 4, "tables in tables");
    Table table;
    const auto size = lua_rawlen(L, index);
    for (lua_Unsigned i = 1; i <= size; ++i, lua_pop(L, 1)) {
        lua_rawgeti(L, index, static_cast<lua_Integer>(i));
        table.list.push_back(value_at(L, -1, depth));
    }
    const int top = lua_gettop(L);
    for (lua_pushnil(L); lua_next(L, index); lua_settop(L, top + 1)) {
        if (lua_isinteger(L, top + 1) && lua_tointeger(L, top + 1) >= 1 &&
            lua_tointeger(L, top + 1) <= static_cast<lua_Integer>(size))
            continue;
        if (lua_type(L, top + 1) != LUA_TSTRING) throw UserError({}, "has a key that is neither a place nor a name");
        const std::string key = text_at(L, top + 1);
        table.named.emplace(key, value_at(L, top + 2, depth));
    }
    return table;
}

// It may be the name of a file, which is in whatever letters its disk has.
std::string GraphScript::bytes_at(lua_State* L, int index) {
    std::size_t size = 0;
    const char* const text = lua_tolstring(L, index, &size);
    count(size);
    return {text, size};
}

std::string GraphScript::text_at(lua_State* L, int index) {
    auto text = bytes_at(L, index);
    if (!is_utf8(text)) throw UserError({}, "is not a text in UTF-8");
    return text;
}

void GraphScript::count(std::size_t bytes) {
    bytes_ += bytes;
    if (++values_ > most_values) throw Error("a graph has at most " + std::to_string(most_values) + " values");
    if (bytes_ > most_text_bytes) throw Error("the texts of a graph have at most 4 MiB");
}

// Told when the node's name is known. What would not be told is not kept.
void GraphScript::note(Made& made, const std::string& complaint) {
    if (++noted_ <= ProblemList::most) made.complaints.push_back(shortened(complaint, ProblemList::longest));
}

void GraphScript::assigned(lua_State* L, const std::string& name) {
    if (name == "frame" || name == "fps" || name == "time") take_rate(L, name);
    const auto* number = node_at(L, 3);
    if (!number) return;
    Node& node = made_[*number].node;
    if (!named_.contains(name)) remember(name);
    named_.emplace(name, *number);
    if (!node.name.empty()) return;
    node.name = is_utf8(name) ? name : "?";
    order_.push_back(*number);
}

void GraphScript::resolve(Value& value) const {
    if (auto* ref = std::get_if<NodeRef>(&value.data)) {
        if (ref->name[0] == by_number)
            ref->name = made_[std::stoul(ref->name.substr(1))].node.name;
        else if (const auto at = named_.find(ref->name); at != named_.end())
            ref->name = made_[at->second].node.name;
    } else if (auto* table = std::get_if<Table>(&value.data)) {
        for (auto& entry : table->list) resolve(entry);
        for (auto& [key, entry] : table->named) resolve(entry);
    }
}

Graph GraphScript::finish() {
    Graph graph{sandbox_.file(), {}};
    std::vector<std::string> names;
    for (const std::size_t number : order_) {
        Node node = made_[number].node;
        for (auto& entry : node.entries) resolve(entry);
        for (auto& [key, value] : node.params) resolve(value);
        names.push_back(node.name);
        graph.nodes.push_back(std::move(node));
    }
    now_.followed = asks_for_motion(graph);
    for (Node& node : graph.nodes)
        if (node.kind == "Scene") place_in_time(node);
    for (const auto& [node, complaints] : made_) {
        for (const auto& what : complaints)
            complain(node.where, node.kind + (node.name.empty() ? "" : " " + in_quotes(node.name)) + ": " + what);
        if (node.name.empty())
            complain(node.where, node.kind + ": the node has no name; write name = " + node.kind +
                                     " { … }, without local and not inside another table");
    }
    if (noted_ > ProblemList::most) problems_.leave_out(noted_ - ProblemList::most);
    Globals::finish(names);
    return graph;
}

}  // namespace lightnet::lua
