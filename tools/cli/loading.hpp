// Loading: from the names of files to what may run.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/kind.hpp"
#include "core/run/forecast/mover.hpp"
#include "lua/graph_reader.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/render.hpp"

namespace lightnet {

/// What the files say that the user named, before anything is checked.
struct Written {
    Graph graph;
    Hosts hosts;                    // empty without a hosts file
    std::vector<Problem> problems;  // on the way to them
};

Written read_files(const GraphOptions& graph, const std::string& hosts);
/// For a process with threads: the graph as `reader` reads it. A hosts file is no graph, so `hosts` are there already.
Written read_files(const GraphOptions& graph, GraphReader& reader, const Hosts& hosts);
/// Those of a hosts file, or of addresses with commas between them; "": none. Throws UserError.
Hosts read_hosts(const std::string& hosts);
/// `graph`, whose text is there if it comes from standard input, which can be read but once. Throws UserError.
GraphOptions taken_from_standard_input(GraphOptions graph);
/// For `lightnet render`. Evaluates Lua, so call it before the scene is read: reading starts threads, and Lua runs in
/// a child, which would have nothing of them but their locks.
Written read_files(const RenderedScene& scene, const std::string& hosts);

/// A sound graph, and where it runs.
struct Loaded {
    Graph graph;  // checked
    Hosts hosts;  // those for this process have their number of places
    std::vector<Problem> warnings, notes;
    std::shared_ptr<const LaidOut> laid_out{};  // by what they hold what they do; null: somebody has said so
};

/// Applies what the user wants otherwise, and checks all of it. Throws UserError that names all problems of the graph,
/// of the hosts and of the way to the scene.
Loaded validate_job(Written written, const PictureOptions& wanted, const Registry& registry);
/// Hosts that have a name which nobody is called by. It may be known when they are there: no reason not to begin.
std::vector<Problem> unknown_names(const Hosts& hosts);

void warn(const std::vector<Problem>& warnings, std::ostream& err);

}  // namespace lightnet
