// From the names of files to what may run.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/kind.hpp"
#include "tools/options.hpp"

namespace lightnet {

/// A sound graph, and where it runs.
struct Loaded {
    Graph graph;  // checked
    Hosts hosts;  // empty without a hosts file
    std::vector<Problem> warnings, notes;
};

/// Reads the files that the options name, applies what they override, and checks all of it. Throws UserError that
/// names all problems of the graph, of the hosts and of the way to the scene. `names_of_hosts`: look hosts up, too.
Loaded load(const Options& options, const Registry& registry, bool names_of_hosts);

/// What the files of a `lightnet render` say, before its scene is read.
struct Written {
    Graph graph;
    Hosts hosts;
    std::vector<Problem> problems;  // on the way to them
};

/// Reads a graph for `lightnet render`, and its hosts. Evaluates Lua, so call it before the scene is read: reading
/// starts threads, and Lua runs in a child, which would have nothing of them but their locks.
Written read_render(const Options& options);
/// Makes it sound, as load() does. The scene itself has been read by now.
Loaded load_render(Written written, const Options& options, const Registry& registry);

}  // namespace lightnet
