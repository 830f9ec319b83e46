#include "lua/load_graph.hpp"

#include <functional>
#include <new>
#include <utility>

#include "core/network/graph/check.hpp"
#include "core/network/graph/json.hpp"
#include "lua/child.hpp"
#include "lua/files.hpp"
#include "lua/graph_script.hpp"
#include "lua/hosts_script.hpp"
#include "lua/sandbox.hpp"

namespace lightnet {
namespace {

/// What a child answers: the value's JSON ("" when the file didn't come to its end), and what is wrong.
struct Answer {
    std::string value;
    std::vector<Problem> problems;
};

constexpr std::size_t beside_lua = std::size_t{256} << 20;  // bytes for what a file's values become

using Text = std::function<std::string()>;  // read in the child, so that an endless file costs only the child

// A JSON text has no line break in it, so one keeps the two apart.
std::string pack(const Answer& answer) { return to_json(answer.problems) + "\n" + answer.value; }

Answer unpack(const std::string& text) {
    const auto end = text.find('\n');
    if (end == std::string::npos) throw Error("malformed answer");
    return {text.substr(end + 1), problems_from_json(std::string_view(text).substr(0, end))};
}

template <class Script>
Answer run_script(const std::string& file, const Text& text, const LuaOptions& options) {
    Answer answer;
    try {
        lua::Sandbox sandbox(file, options.memory);
        Script script(sandbox, options);
        sandbox.run(text());
        answer.value = to_json(script.finish());
        answer.problems = script.take_problems();
    } catch (const UserError& error) {
        answer.problems = error.problems();
    } catch (const std::bad_alloc&) {
        throw;  // there may be no room to say it
    } catch (const std::exception& error) {
        answer.problems = {{{file, 0}, error.what()}};
    }
    return answer;
}

template <class Script>
Answer evaluate(const std::string& file, const Text& text, const LuaOptions& options) {
    const lua::Budget budget{options.cpu_seconds, options.wall_seconds, options.memory + beside_lua};
    Answer answer;
    try {
        answer = unpack(lua::in_child(budget, [&] { return pack(run_script<Script>(file, text, options)); }));
    } catch (const Error& error) {
        throw UserError({file, 0}, error.what());
    }
    if (answer.value.empty()) throw UserError(std::move(answer.problems));
    return answer;
}

GraphFile read(const std::string& file, const Text& text, const LuaOptions& options) {
    Answer answer = evaluate<lua::GraphScript>(file, text, options);
    sort_by_line(answer.problems, file);
    return {graph_from_json(answer.value), std::move(answer.problems)};
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

}  // namespace

GraphFile read_graph(const std::string& file, const LuaOptions& options) { return read(file, text_of(file), options); }

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
