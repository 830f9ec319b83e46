// The graphs and hosts files of the paper's tables, as they are shipped, for the benchmarks of those tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"

namespace lightnet::bench {

/// graphs/paper/NAME.lua, with other values for some of its constants.
Graph paper_graph(const std::string& name, const std::map<std::string, std::string>& constants = {});
/// graphs/paper/hosts/NAME.lua, with these for its endpoints, in its order. Throws where it names fewer or more.
Hosts paper_hosts(const std::string& name, const std::vector<std::string>& endpoints);

/// What nodes of an emulated network wait: microseconds per question, of the image as well, which asks so many
/// questions in a tile.
struct EmulatedCosts {
    std::map<std::string, double> microseconds;  // by node; others: none
    double questions = 0;                        // per tile
};
/// On hosts with so many places each, laid out as graphs/paper/hosts/HOSTS.lua says, the network of
/// graphs/paper/GRAPH.lua of nodes that wait: the seconds that one place would wait in all, over those that all of them
/// took; of each round.
std::vector<double> emulated_efficiency(const std::string& graph, const std::string& hosts,
                                        const std::vector<std::uint32_t>& places, const EmulatedCosts& costs,
                                        std::size_t tiles);

}  // namespace lightnet::bench
