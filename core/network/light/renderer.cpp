#include "core/network/light/renderer.hpp"

#include <vector>

namespace lightnet {

void Renderer::render(const Tile& tile, std::span<Rgb> pixels) const {
    if (tile.blocks() == 1) return render_block(tile, pixels);
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
