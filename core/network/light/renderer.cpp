#include "core/network/light/renderer.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lightnet {
namespace {

// Gives each pixel of a coarse look what the one that was looked at shows, beside it or above.
void show_neighbours(const Tile& tile, std::span<Rgb> pixels) {
    const std::size_t colours = pixels.size() / tile.pixels();
    for (std::size_t y = 0; y < tile.height; ++y)
        for (std::size_t x = 0; x < tile.width; ++x) {
            const std::size_t from = (y - y % tile.stride) * tile.width + x - x % tile.stride, to = y * tile.width + x;
            if (from != to)
                std::copy_n(pixels.begin() + std::ptrdiff_t(from * colours), colours,
                            pixels.begin() + std::ptrdiff_t(to * colours));
        }
}

}  // namespace

void Renderer::render(const Tile& tile, std::span<Rgb> pixels) const {
    if (tile.blocks() == 1) {
        render_block(tile, pixels);
        if (tile.coarse) show_neighbours(tile, pixels);
        return;
    }
    std::vector<Rgb> block;
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
