// Reads what users write: graph files and hosts files, in Lua 5.4.
//
// A file is run in a child process that sees no io, os, package, debug, load or other process's descriptors, and that
// is killed when its budget ends. What comes back is data; the Lua state ends with the child.
//
// A graph file: `name = Kind { inputs…, key = value… }`. The global on the left names the node; nodes stand in the
// graph in the order in which they are named; an input may be named further down. A node without a name of its own
// (local, or written inside another node) is an error, because layers, hosts and random numbers go by names; a second
// global for the same node is only another way to write it. Other globals are constants, which `-D name=value`
// overrides; `frame`, `frames`, `fps` and `time` are there from the beginning. A name that the file uses but nobody
// gives is a problem, never silently nil.
//
// A hosts file: `place "tcp://host:7777" { node = replicas… }`; without a table, or with an empty one, each place of
// the host holds the whole network; `places = N` in it says how many places the host has, and `key = "…"` what its
// public key is. `place "here"`, as often as one likes, names places of the launcher's own process in the same way.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"

namespace lightnet {

/// Which frame of a sequence a graph is evaluated for: its `frame`, `frames`, `fps` and `time`. A still is the first of
/// one.
struct GraphFrame {
    int number = 1;
    int count = 1;       // the last one's number
    bool asked = false;  // somebody has asked for it: what moves in files of scenes stands as it then does
};

/// What a file may cost, and which of its constants are overridden.
struct LuaOptions {
    std::map<std::string, std::string> constants = {};  // -D name=value; the type is that of the file's own value
    double cpu_seconds = 2;                             // processor time
    double wall_seconds = 10;
    std::size_t memory = std::size_t{256} << 20;  // bytes of Lua values
    GraphFrame frame = {};
};

/// A graph as its file gives it, and what is wrong with the file besides. For those who tell all problems at once.
struct GraphFile {
    Graph graph;
    std::vector<Problem> problems;
    bool alone = false;  // nothing but this file and the options was looked at
};

/// Forks, so call it before threads are started. A file whose name ends in ".json" has a graph as to_json() writes it,
/// see read_graph_text(). Throws UserError when the file can't be run to its end.
GraphFile read_graph(const std::string& file, const LuaOptions& options = {});

/// What a graph that comes from standard input is called, and what asks for it in the place of a file's name.
inline constexpr const char* standard_input_name = "<stdin>";
inline constexpr const char* standard_input_word = "-";

/// All of it, to its end. Throws UserError.
std::string graph_from_standard_input();

/// As read_graph(), for a text that stands for the file called `file`; or for a graph as to_json() writes it, which
/// knows its own file and lines, and has no constants and no frames. Throws UserError.
GraphFile read_graph_text(const std::string& text, const std::string& file, const LuaOptions& options = {});

/// As read_graph(), but throws UserError when there is any problem.
Graph load_graph(const std::string& file, const LuaOptions& options = {});

/// As load_graph(), for a text that stands for the file called `file`.
Graph parse_graph(const std::string& text, const std::string& file, const LuaOptions& options = {});

/// Reads a hosts file; as load_graph() otherwise.
Hosts load_hosts(const std::string& file, const LuaOptions& options = {});

/// As load_hosts(), for a text that stands for the file called `file`.
Hosts parse_hosts(const std::string& text, const std::string& file, const LuaOptions& options = {});

}  // namespace lightnet
