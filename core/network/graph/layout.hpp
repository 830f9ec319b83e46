// The layout of a node's replicas: each has all that was prepared, or a sector of the scene.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

enum class Layout : std::uint8_t {
    replicated,  // every replica has all, and answers any question
    sharded,     // each has what lies in its sector of the scene or near it, and answers the questions there
};

/// As they are called in hosts files, in the order of the enum.
inline constexpr std::array<std::string_view, 2> layout_names{"replicated", "sharded"};

constexpr std::optional<Layout> layout_called(std::string_view name) {
    for (std::size_t i = 0; i < layout_names.size(); ++i)
        if (layout_names[i] == name) return static_cast<Layout>(i);
    return std::nullopt;
}

/// How many sectors each entry of the hosts file holds of a node, in the order of the file: as many as it names
/// replicas, or one for all places of a host that holds the whole network.
std::vector<std::uint32_t> sectors_by_host(const Hosts& hosts, const std::string& node);

/// Which nodes are to be sharded, by name, and into how many sectors: those that the hosts file has in that layout,
/// with more than one sector. A layout for all nodes means those that can be sharded. Nodes whose frozen state others
/// take are never. Whether it makes sense is said by
/// check_hosts().
std::map<std::string, std::uint32_t> shards_of(const Graph& graph, const Registry& registry, const Hosts& hosts);

/// Does another node take what this one keeps? Then each place needs all of it.
bool is_taken(const Graph& graph, std::size_t node);

constexpr std::uint32_t most_sectors = 1024;

/// The graph with a node of its own for each sector, behind all others: "photons#1", "photons#2", … , made like the
/// node itself, which stays as the one whom others ask, and which no place holds. Throws Error when there is no such
/// node, or when a count makes no sense.
Graph sharded(Graph graph, const std::map<std::string, std::uint32_t>& shards);
/// What was given to sharded().
std::map<std::string, std::uint32_t> shards_in(const Graph& graph);

/// The nodes that stand for the sectors of `node`, in order; empty: it is not sharded.
std::vector<std::size_t> sectors_of(const Graph& graph, std::size_t node);
/// The sector that `node` stands for; none: it is an ordinary node.
const Sector* sector_at(const Graph& graph, std::size_t node);
/// The node whose sector `node` stands for, or itself.
std::size_t whole_of(const Graph& graph, std::size_t node);
/// How many nodes the user wrote.
std::size_t written_nodes(const Graph& graph);
/// The graph without its sectors.
Graph written(Graph graph);

}  // namespace lightnet
