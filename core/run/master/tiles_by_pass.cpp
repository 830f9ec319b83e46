#include "core/run/master/tiles_by_pass.hpp"

#include <algorithm>
#include <utility>

#include "core/run/assembly/prepared.hpp"

namespace lightnet {

TilesByPass::TilesByPass(const Graph& graph, const Registry& registry, const std::vector<Tile>& tiles) {
    const auto renewed = renewed_nodes(graph, registry);
    by_pass_ = std::find(renewed.begin(), renewed.end(), true) != renewed.end();
    add(tiles);
    if (!left_.empty()) pass_ = left_.begin()->first;
}

void TilesByPass::add(const std::vector<Tile>& tiles) {
    for (const Tile& tile : tiles) {
        if (!by_pass_)
            left_[0].push_back(tile);
        else
            for (const Tile& block : one_by_one(tile)) left_[pass_of(block)].push_back(block);
    }
}

std::vector<Tile> TilesByPass::begin_next() {
    auto next = left_.extract(left_.begin());
    pass_ = next.key();
    return std::move(next.mapped());
}

std::vector<Tile> TilesByPass::sort(const std::vector<Tile>& more) {
    add(more);
    const auto now = left_.find(pass_);
    return now == left_.end() ? std::vector<Tile>{} : std::move(left_.extract(now).mapped());
}

}  // namespace lightnet
