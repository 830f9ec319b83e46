// A graph, as its file says it: a plain value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/value.hpp"

namespace lightnet {

/// One node of the graph: `name = Kind { inputs…, key = value… }`.
struct Node {
    std::string name;  // what stands on the left
    std::string kind;
    std::vector<Value> entries;           // what stands in the array part: inputs (NodeRef), or a scene's file name
    std::map<std::string, Value> params;  // string keys; check() fills in the defaults
    SourceLine where;
    friend bool operator==(const Node&, const Node&) = default;
};

/// What one of a sharded node's parts is: see sharded().
struct Sector {
    std::uint32_t node = 0;   // index of the node as the user wrote it
    std::uint32_t index = 0;  // among its sectors
    std::uint32_t count = 1;  // of its sectors
    friend bool operator==(const Sector&, const Sector&) = default;
};

/// A graph, in the order of its file. Plain data: copyable, comparable, sendable.
struct Graph {
    std::string file;               // the graph file, as named by the user
    std::vector<Node> nodes;        // in the order in which the file names them, and one for each sector behind them
    std::vector<Sector> sectors{};  // of sharded nodes
    friend bool operator==(const Graph&, const Graph&) = default;

    /// Index of the node called `name`.
    std::optional<std::size_t> find(std::string_view name) const;
    /// Indices of the nodes that `node` asks, in the order of its entries. Parameters (a scene) are no inputs.
    std::vector<std::size_t> inputs_of(std::size_t node) const;
    /// Indices of the nodes that lists in its parameters name (a renderer's `show`): asked beside its inputs.
    std::vector<std::size_t> shown_by(std::size_t node) const;
    /// Indices of the nodes that its parameters name, scenes aside: whose frozen state it takes.
    std::vector<std::size_t> taken_by(std::size_t node) const;
    /// All of these: what has to be ready before the node can be.
    std::vector<std::size_t> needed_by(std::size_t node) const;
};

/// How large a graph may be: far more than anybody draws, and little enough that nobody has to fear it. check() refuses
/// what is larger.
inline constexpr std::size_t most_nodes = 4096;
inline constexpr std::size_t most_references = 16384;  // by which nodes name each other
inline constexpr unsigned most_rank = 64;              // each level takes some of a fiber's stack when nodes ask

/// Whom all nodes of a graph name, found at once: asking each node for itself takes time with the square of their
/// number.
struct Edges {
    std::vector<std::vector<std::size_t>> inputs;  // per node, as Graph::inputs_of()
    std::vector<std::vector<std::size_t>> taken;   // as Graph::taken_by()
    std::vector<std::vector<std::size_t>> needed;  // as Graph::needed_by()
    std::vector<std::vector<std::size_t>> scenes;  // that its parameters name
};
Edges edges_of(const Graph& graph);

/// How many references its nodes have.
std::size_t references_in(const Graph& graph);

/// All nodes, each behind those that it needs. Nodes on a cycle, and those that need them, are left out.
std::vector<std::size_t> leaves_first(const Edges& edges);

/// Per node, how far it is above the leaves: 0 without inputs, else one more than its highest input. Throws Error on
/// a cycle, which check() would have named.
std::vector<unsigned> ranks_of(const Graph& graph);

/// Per node, whether the image of `renderer` needs it: the renderer itself, what it asks, and the scenes of these.
std::vector<bool> used_nodes(const Graph& graph, std::size_t renderer);

/// Canonical text (JSON) of a graph: the same graph gives the same bytes. For pipes, plans and hashes. Throws Error
/// when a text in it isn't UTF-8.
std::string to_json(const Graph& graph);
/// Reads it back. Throws Error on anything else, and on more than a graph or a JsonLimits allows.
Graph graph_from_json(std::string_view text);

}  // namespace lightnet
