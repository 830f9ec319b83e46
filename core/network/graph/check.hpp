// Finds everything that is wrong with a graph, before any work starts.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// What check() finds.
struct Examined {
    Graph graph;                    // with defaults filled in
    std::vector<Problem> problems;  // all of them, in the order of the files' lines; empty: the graph is sound
    std::vector<Problem> warnings;  // what works, but is probably not meant: nodes that the image doesn't need, or
                                    // whose bytes are others each time, light that is counted twice
    std::vector<Problem> notes;     // what is often meant, and good to know: light that no node counts
};

/// Finds everything that is wrong: more of it than a graph may have (see graph.hpp), unknown kind or parameter, wrong
/// type or range, missing input, wrong role of an input, duplicate name, cycle, no or several renderers, and what
/// `hosts` says of nodes that the graph doesn't have. Opens no file. A graph may come from a stranger: nothing here
/// recurses over it, and of its problems a hundred are told.
Examined examine(const Graph& graph, const Registry& registry, const Hosts& hosts = {});

/// The graph with defaults filled in. Throws UserError that names *all* problems of examine(), each with file, line,
/// the node's name and a suggestion.
Graph check(const Graph& graph, const Registry& registry, const Hosts& hosts = {});

/// Warnings of nodes whose kind draws random numbers that nobody can seed.
std::vector<Problem> irreproducible_nodes(const Graph& graph, const Registry& registry);

/// Problems of the graph's file first, then of other files, each in the order of lines.
void sort_by_line(std::vector<Problem>& problems, const std::string& first_file);

}  // namespace lightnet
