// The tiles of a picture, one pass after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/film/tile.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// In a graph without nodes that learn anew for each pass, tiles stay as they are. Else they are cut into blocks of
/// samples, of which each is a pass.
class TilesByPass {
public:
    TilesByPass(const Graph& graph, const Registry& registry, const std::vector<Tile>& tiles);

    bool empty() const { return left_.empty(); }
    /// Begins the next pass: its tiles, in the order of handing out. Not when it is empty.
    std::vector<Tile> begin_next();
    /// The pass that goes on, or will be the first: what nodes are to learn for. 0 where none does.
    std::uint32_t pass() const { return by_pass_ ? pass_ : 0; }
    /// Takes more tiles. Returns those that belong to the pass that goes on.
    std::vector<Tile> sort(const std::vector<Tile>& more);

private:
    void add(const std::vector<Tile>& tiles);

    bool by_pass_;
    std::uint32_t pass_ = 0;
    std::map<std::uint32_t, std::vector<Tile>> left_;  // by pass
};

}  // namespace lightnet
