#include "core/film/film_tiling.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.hpp"

namespace lightnet {

FilmTiling::FilmTiling(const FilmFormat& format)
    : window_(format.work()),
      samples_(format.samples),
      blocks_(blocks_in(format.samples)),
      colours_(format.colours()),
      adaptive_(format.adaptive()),
      coarse_(format.coarse) {}

std::uint32_t FilmTiling::samples_in(std::uint32_t blocks) const {
    return std::min(blocks * samples_per_block, samples_);
}

Blocks FilmTiling::group_of(std::uint32_t block) const {
    if (adaptive_) return {block, 1};
    const Blocks group = lightnet::group_of(block);
    return {group.first, std::min(group.count, blocks_ - group.first)};
}

Blocks FilmTiling::handed_out(std::uint32_t block) const {
    return adaptive_ ? Blocks{block, 1} : lightnet::handed_out(block, samples_);
}

// DECISIONS: last-group-apart
bool FilmTiling::is_open(const Blocks& group) const {
    const std::uint32_t of_any_picture = adaptive_ ? 1 : lightnet::group_of(group.first).count;
    return group.first + of_any_picture > samples_ / samples_per_block;
}

bool FilmTiling::is_whole(const Tile& tile) const {
    const Blocks together = handed_out(tile.block());
    return tile.block() == together.first && tile.blocks() == together.count;
}

bool FilmTiling::comes_next(std::uint32_t block, std::uint32_t blocks) const {
    const Blocks group = group_of(block);
    return blocks == group.count && !is_open(group);
}

Tile FilmTiling::block_of(const Window& area, std::uint32_t block) const {
    return {area.x, area.y, area.width, area.height, block * samples_per_block, samples_of(block, samples_)};
}

std::vector<Tile> FilmTiling::areas_of(const Tile& tile) const {
    if (!adaptive_) return {tile};
    std::vector<Tile> cells;
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; y += cell_size)
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; x += cell_size) {
            Tile& cell = cells.emplace_back(tile);
            cell.x = x, cell.width = std::min(cell_size, tile.x + tile.width - x);
            cell.y = y, cell.height = std::min(cell_size, tile.y + tile.height - y);
        }
    return cells;
}

void FilmTiling::expect_valid(const Tile& tile, std::size_t colours) const {
    const auto within = [](std::uint32_t from, std::uint32_t size, std::uint32_t begin, std::uint32_t extent) {
        return size > 0 && from >= begin && from - begin < extent && size <= extent - (from - begin);
    };
    const auto of_cells = [&](std::uint32_t from, std::uint32_t size, std::uint32_t end) {
        return !adaptive_ || (from % cell_size == 0 && (size % cell_size == 0 || from + size == end));
    };
    const bool inside = within(tile.x, tile.width, window_.x, window_.width) &&
                        within(tile.y, tile.height, window_.y, window_.height) &&
                        of_cells(tile.x, tile.width, window_.x + window_.width) &&
                        of_cells(tile.y, tile.height, window_.y + window_.height);
    const bool of_look = (tile.coarse != 0) == coarse_;
    const bool of_blocks = tile.first_sample % samples_per_block == 0 && tile.first_sample < samples_ &&
                           (tile.samples == samples_of(tile.block(), samples_) ||
                            (is_whole(tile) && tile.samples == samples_of(handed_out(tile.block()), samples_)));
    if (!inside || !of_blocks || !of_look)
        throw Error("film", fmt::format("no tile of this picture: {}x{} pixels at {},{}, {} samples from {}",
                                        tile.width, tile.height, tile.x, tile.y, tile.samples, tile.first_sample));
    if (colours != tile.told() * colours_)
        throw Error("film", fmt::format("a tile of {} pixels and {} layers came with {} colours", tile.told(), colours_,
                                        colours));
}

}  // namespace lightnet
