// Tiles of a picture, in the order in which they are handed out.
#include <algorithm>
#include <bit>
#include <utility>

#include "core/film/film_format.hpp"

namespace lightnet {
namespace {

struct Cell {
    std::uint32_t x = 0, y = 0;
};

// The d-th cell of a Hilbert curve through a square of `side` (a power of two) cells.
Cell hilbert(std::uint32_t side, std::uint64_t d) {
    Cell cell;
    for (std::uint32_t s = 1; s < side; s *= 2, d /= 4) {
        const bool right = d & 2, up = (d ^ (d >> 1)) & 1;
        if (!up) {
            if (right) cell = {s - 1 - cell.x, s - 1 - cell.y};
            std::swap(cell.x, cell.y);
        }
        cell.x += right ? s : 0;
        cell.y += up ? s : 0;
    }
    return cell;
}

std::uint32_t up_to_whole(std::uint32_t number, std::uint32_t step) { return (number + step - 1) / step * step; }

}  // namespace

// DECISIONS: block-groups
std::vector<Tile> one_by_one(const Tile& tile) {
    std::vector<Tile> blocks(tile.blocks(), tile);
    for (std::uint32_t i = 0; i < blocks.size(); ++i) {
        blocks[i].first_sample = tile.first_sample + i * samples_per_block;
        blocks[i].samples = samples_of(i, tile.samples);
    }
    return blocks;
}

Blocks handed_out(std::uint32_t block, std::uint32_t samples) {
    const std::uint32_t full = samples / samples_per_block;
    if (block >= full) return {block, 1};
    const Blocks group = group_of(block);
    return {group.first, std::min(group.count, full - group.first)};
}

std::vector<Tile> tiles_of(std::uint32_t width, std::uint32_t height, std::uint32_t tile_size, std::uint32_t samples) {
    return tiles_of(Window{0, 0, width, height}, tile_size, samples);
}

std::vector<Tile> tiles_of(const Window& window, std::uint32_t tile_size, std::uint32_t samples) {
    const std::uint32_t width = window.width, height = window.height;
    if (!width || !height || !tile_size) return {};
    const std::uint32_t columns = (width - 1) / tile_size + 1, rows = (height - 1) / tile_size + 1;
    const std::uint32_t side = std::bit_ceil(std::max(columns, rows));
    std::vector<Tile> tiles;
    tiles.reserve(std::size_t{columns} * rows * blocks_in(samples));
    for (std::uint64_t d = 0; d < std::uint64_t{side} * side; ++d) {
        const auto [column, row] = hilbert(side, d);
        if (column >= columns || row >= rows) continue;
        const std::uint32_t x = column * tile_size, y = row * tile_size;
        tiles.push_back(
            {window.x + x, window.y + y, std::min(tile_size, width - x), std::min(tile_size, height - y), 0, 0});
    }
    const std::size_t per_group = tiles.size(), blocks = blocks_in(samples);
    if (blocks == 0) return {};
    for (std::uint32_t block = 0, group = 0; block < blocks; block += handed_out(block, samples).count, ++group)
        for (std::size_t i = 0; i < per_group; ++i) {
            if (block > 0) tiles.push_back(tiles[i]);
            Tile& tile = tiles[group * per_group + i];
            tile.first_sample = block * samples_per_block;
            tile.samples = samples_of(handed_out(block, samples), samples);
        }
    return tiles;
}

FilmFormat coarse_look(FilmFormat picture) {
    picture.samples = 1;
    picture.refinement = {};
    picture.coarse = true;
    return picture;
}

std::vector<Tile> tiles_of(const FilmFormat& format, std::uint32_t tile_size) {
    if (format.coarse) {
        auto tiles = tiles_of(format.work(), tile_size, 1);
        for (Tile& tile : tiles) tile.stride = coarse_stride, tile.coarse = 1;
        return tiles;
    }
    if (!format.adaptive()) return tiles_of(format.work(), tile_size, format.least_samples());
    // Cells decide block by block.
    std::vector<Tile> tiles;
    for (const Tile& tile : tiles_of(format.work(), up_to_whole(tile_size, cell_size), format.least_samples()))
        for (const Tile& block : one_by_one(tile)) tiles.push_back(block);
    std::stable_sort(tiles.begin(), tiles.end(),
                     [](const Tile& a, const Tile& b) { return a.first_sample < b.first_sample; });
    return tiles;
}

std::uint32_t FilmFormat::least_samples() const {
    if (!adaptive() || samples <= 2 * samples_per_block) return samples;
    const std::uint32_t wanted = std::clamp(refinement.least, 2 * samples_per_block, samples);
    return std::min(samples, up_to_whole(wanted, samples_per_block));
}

Window FilmFormat::work() const {
    const Window wanted = crop.value_or(Window{0, 0, width, height});
    if (!adaptive()) return wanted;
    const std::uint32_t x = wanted.x / cell_size * cell_size, y = wanted.y / cell_size * cell_size;
    return {x, y, std::min(width, up_to_whole(wanted.x + wanted.width, cell_size)) - x,
            std::min(height, up_to_whole(wanted.y + wanted.height, cell_size)) - y};
}

}  // namespace lightnet
