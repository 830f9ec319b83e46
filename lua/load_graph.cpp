#include "lua/load_graph.hpp"

#include <algorithm>
#include <functional>
#include <new>
#include <set>
#include <utility>

#include "core/base/in_quotes.hpp"
#include "core/base/words_of.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/frames_beside.hpp"
#include "core/network/graph/json.hpp"
#include "lua/answer.hpp"
#include "lua/child.hpp"
#include "lua/files.hpp"
#include "lua/graph_script.hpp"
#include "lua/hosts_script.hpp"
#include "lua/sandbox.hpp"

namespace lightnet {
namespace {

using lua::Answer;

constexpr std::size_t beside_lua = std::size_t{256} << 20;  // bytes for what a file's values become

using Text = std::function<std::string()>;  // read in the child, so that an endless file costs only the child

Graph evaluated(const std::string& file, const std::string& text, const LuaOptions& options) {
    lua::Sandbox sandbox(file, options.memory);
    lua::GraphScript script(sandbox, options);
    sandbox.run(text);
    Graph graph = script.finish();
    if (auto problems = script.take_problems(); !problems.empty()) throw UserError(std::move(problems));
    return graph;
}

/// The graph as it is in another frame. Throws UserError, which names that, where it can't be.
Graph graph_in(int frame, const std::string& file, const std::string& text, LuaOptions options) {
    options.frame.number = frame;
    options.constants["frame"] = std::to_string(frame);
    try {
        return evaluated(file, text, options);
    } catch (const UserError& error) {
        auto problems = error.problems();
        for (Problem& problem : problems)
            problem.what = "in frame " + std::to_string(frame) + ", which is beside it: " + problem.what;
        throw UserError(std::move(problems));
    }
}

// False: frames beside it were looked at, and whatever these ask for.
bool complete(Graph& graph, const lua::GraphScript& script, const std::string& file, const std::string& text,
              const LuaOptions& options) {
    bool alone = true;
    note_frames_beside(graph, [&](int by) {
        alone = false;
        return graph_in(script.frame() + by, file, text, options);
    });
    return alone;
}
bool complete(Hosts&, const lua::HostsScript&, const std::string&, const std::string&, const LuaOptions&) {
    return true;
}

template <class Script>
Answer run_script(const std::string& file, const Text& text_of, const LuaOptions& options) {
    Answer answer;
    try {
        lua::Sandbox sandbox(file, options.memory);
        Script script(sandbox, options);
        const std::string text = text_of();
        sandbox.run(text);
        auto value = script.finish();
        answer.problems = script.take_problems();
        if (answer.problems.empty())
            answer.alone = complete(value, script, file, text, options) && lua::is_alone(sandbox);
        answer.value = to_json(value);
    } catch (const UserError& error) {
        answer.problems = error.problems();
    } catch (const std::bad_alloc&) {
        throw;  // there may be no room to say it
    } catch (const std::exception& error) {
        answer.problems = {{{file, 0}, words_of(error)}};
    }
    return answer;
}

template <class Script>
Answer evaluate(const std::string& file, const Text& text, const LuaOptions& options) {
    const lua::Budget budget{options.cpu_seconds, options.wall_seconds, options.memory + beside_lua};
    Answer answer;
    try {
        answer = lua::unpack(lua::in_child(budget, [&] { return lua::pack(run_script<Script>(file, text, options)); }));
    } catch (const Error& error) {
        throw UserError({file, 0}, error.what());
    }
    if (answer.value.empty()) throw UserError(std::move(answer.problems));
    return answer;
}

GraphFile read(const std::string& file, const Text& text, const LuaOptions& options) {
    Answer answer = evaluate<lua::GraphScript>(file, text, options);
    sort_by_line(answer.problems, file);
    return {graph_from_json(answer.value), std::move(answer.problems), answer.alone};
}

Graph sound(GraphFile read) {
    if (!read.problems.empty()) throw UserError(std::move(read.problems));
    return std::move(read.graph);
}

Hosts sound_hosts(const std::string& file, const Text& text, const LuaOptions& options) {
    Answer answer = evaluate<lua::HostsScript>(file, text, options);
    sort_by_line(answer.problems, file);
    if (!answer.problems.empty()) throw UserError(std::move(answer.problems));
    return hosts_from_json(answer.value);
}

Text text_of(const std::string& file) {
    return [file] { return lua::read_text(file); };
}

// No Lua begins like this.
bool is_json(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r\n");
    return first != std::string::npos && text[first] == '{';
}

// What Lua's own globals can't be.
std::vector<Problem> odd_names(const Graph& graph) {
    std::vector<Problem> problems;
    std::set<std::string> names;
    const auto is_part = [](char c) {
        return c == '_' || ('0' <= c && c <= '9') || ('a' <= (c | 32) && (c | 32) <= 'z');
    };
    for (const auto& [name, kind, entries, params, where] : graph.nodes) {
        if (name.empty() || ('0' <= name[0] && name[0] <= '9') || !std::all_of(name.begin(), name.end(), is_part))
            problems.push_back({where, kind + " " + in_quotes(name) + ": a name is made of letters, digits and _"});
        else if (!names.insert(name).second)
            problems.push_back({where, kind + " " + in_quotes(name) + ": another node has this name"});
    }
    return problems;
}

GraphFile read_json(const std::string& text, const std::string& file, const LuaOptions& options) {
    if (!options.constants.empty())
        throw UserError({file, 0}, "is a graph in JSON, which has no constants: -D " +
                                       options.constants.begin()->first + " changes nothing in it");
    if (options.frame.asked)
        throw UserError({file, 0}, "is a graph in JSON, which is the same in all frames: --frames takes one in Lua");
    try {
        Graph graph = graph_from_json(text);
        auto problems = odd_names(graph);
        return {std::move(graph), std::move(problems)};
    } catch (const Error& error) {
        throw UserError({file, 0}, error.what());
    }
}

}  // namespace

GraphFile read_graph(const std::string& file, const LuaOptions& options) try {
    return file.ends_with(".json") ? read_json(lua::read_text(file), file, options)
                                   : read(file, text_of(file), options);
} catch (const UserError&) {
    throw;
} catch (const Error& error) {
    throw UserError({file, 0}, error.what());
}

std::string graph_from_standard_input() try { return lua::read_standard_input(); } catch (const Error& error) {
    throw UserError({standard_input_name, 0}, error.what());
}

GraphFile read_graph_text(const std::string& text, const std::string& file, const LuaOptions& options) {
    if (is_json(text)) return read_json(text, file, options);
    return read(
        file, [&] { return text; }, options);
}

Graph load_graph(const std::string& file, const LuaOptions& options) { return sound(read_graph(file, options)); }

Graph parse_graph(const std::string& text, const std::string& file, const LuaOptions& options) {
    return sound(read(
        file, [&] { return text; }, options));
}

Hosts load_hosts(const std::string& file, const LuaOptions& options) {
    return sound_hosts(file, text_of(file), options);
}

Hosts parse_hosts(const std::string& text, const std::string& file, const LuaOptions& options) {
    return sound_hosts(
        file, [&] { return text; }, options);
}

}  // namespace lightnet
