#include "core/network/light/renderer.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lightnet {
namespace {

// Of all pixels of a coarse look those that are told.
void tell(const Tile& tile, std::span<const Rgb> all, std::span<Rgb> told) {
    const std::size_t colours = told.size() / tile.told();
    auto next = told.begin();
    for (std::size_t y = 0; y < tile.height; y += tile.stride)
        for (std::size_t x = 0; x < tile.width; x += tile.stride)
            next = std::ranges::copy(all.subspan((y * tile.width + x) * colours, colours), next).out;
}

}  // namespace

void Renderer::render(const Tile& tile, std::span<Rgb> pixels) const {
    std::vector<Rgb> block;
    if (tile.coarse) {
        block.resize(pixels.size() / tile.told() * tile.pixels());
        render_block(tile, block);
        return tell(tile, block, pixels);
    }
    if (tile.blocks() == 1) return render_block(tile, pixels);
    for (const Tile& next : one_by_one(tile)) {
        if (next.block() == tile.block()) {
            render_block(next, pixels);
            continue;
        }
        block.assign(pixels.size(), {});
        render_block(next, block);
        addition_(pixels, block);
    }
}

}  // namespace lightnet
