#include "core/run/master/cut_tiles.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {
namespace {

constexpr std::uint32_t least_side = 8;  // pixels: below that, rays of neighbours would hardly be traced together

// Halves the longer side; of a coarse look so that both halves look at what the whole did.
bool halve(const Tile& tile, Tile& first, Tile& second) {
    first = second = tile;
    const std::uint32_t step = tile.step();
    const auto half = [&](std::uint32_t side) { return side / 2 / step * step; };
    if (std::max(tile.width, tile.height) < 2 * least_side) return false;
    if (tile.width >= tile.height) {
        first.width = half(tile.width);
        second.x += first.width, second.width -= first.width;
    } else {
        first.height = half(tile.height);
        second.y += first.height, second.height -= first.height;
    }
    return true;
}

void cut_into(std::vector<Tile>& pieces, const Tile& tile, std::size_t pixels) {
    Tile first, second;
    if (tile.pixels() <= pixels || !halve(tile, first, second)) return pieces.push_back(tile);
    cut_into(pieces, first, pixels);
    cut_into(pieces, second, pixels);
}

}  // namespace

std::vector<Tile> CutTiles::cut(const Tile& tile, std::size_t pixels) {
    std::vector<Tile> pieces;
    cut_into(pieces, tile, pixels);
    if (pieces.size() == 1) return pieces;
    const auto part = std::make_shared<Part>(Part{{tile, {}}, pieces.size()});
    for (const auto& piece : pieces) parts_.emplace(key_of(piece), part);
    return pieces;
}

std::optional<CutTiles::Whole> CutTiles::put(const Tile& piece, std::span<const Rgb> pixels) {
    const auto part = std::move(parts_.extract(key_of(piece)).mapped());
    auto& whole = part->whole;
    const std::size_t colours = pixels.size() / piece.told(), columns = piece.columns();
    const std::uint32_t step = piece.step();
    whole.pixels.resize(whole.tile.told() * colours);
    for (std::size_t row = 0; row < piece.rows(); ++row) {
        const std::size_t first =
            ((piece.y - whole.tile.y) / step + row) * whole.tile.columns() + (piece.x - whole.tile.x) / step;
        std::ranges::copy(pixels.subspan(row * columns * colours, columns * colours),
                          whole.pixels.begin() + static_cast<std::ptrdiff_t>(first * colours));
    }
    if (--part->missing > 0) return std::nullopt;
    return std::move(whole);
}

}  // namespace lightnet
