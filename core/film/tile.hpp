// A piece of the picture, and of its samples.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace lightnet {

/// Samples of a pixel are added up in blocks of this many. Fixed for ever: the bytes of a picture depend on it.
inline constexpr std::uint32_t samples_per_block = 16;
/// Blocks are added up in groups of at most this many.
inline constexpr std::uint32_t blocks_per_group = 8;

/// Some blocks, one behind the other.
struct Blocks {
    std::uint32_t first = 0, count = 0;
};

/// The group of a block. Blocks of a group are added up in the order of their index, and groups likewise, so that the
/// sum of a group is the same wherever it was made. Groups grow from one block to blocks_per_group: much of the picture
/// is seen early, and later the sum of many samples is sent at once. Fixed for ever.
constexpr Blocks group_of(std::uint32_t block) {
    const std::uint32_t count = std::clamp(std::bit_floor(block), 1u, blocks_per_group);
    return {block / count * count, count};
}

/// Of a first, coarse look at a picture, every second pixel of every second row is rendered.
inline constexpr std::uint32_t coarse_stride = 2;

/// One block of samples, or a whole group of them, for a rectangle of pixels: the unit of work of a renderer. In a
/// rehearsal only pixels whose x and y are multiples of the stride are looked at, and nobody wants to see them. In a
/// first, coarse look at a picture pixels are counted from the tile's own corner, and only those that are looked at are
/// told, row by row; in the film the others show what their neighbour does.
struct Tile {
    std::uint32_t x = 0, y = 0;  // of the upper left pixel, in the picture
    std::uint32_t width = 0, height = 0;
    std::uint32_t first_sample = 0;  // a multiple of samples_per_block
    std::uint32_t samples = 0;       // 1 … samples_per_block, or as many as the group has
    std::uint32_t stride = 0;        // of a rehearsal or a coarse look; 0: it is for the picture
    std::uint32_t coarse = 0;        // 1: it is a coarse look, of one sample

    std::size_t pixels() const { return std::size_t{width} * height; }
    /// From one pixel that is told to the next.
    std::uint32_t step() const { return coarse ? stride : 1; }
    std::uint32_t columns() const { return (width - 1) / step() + 1; }
    std::uint32_t rows() const { return (height - 1) / step() + 1; }
    std::size_t told() const { return std::size_t{columns()} * rows(); }
    bool rehearses() const { return stride > 0 && !coarse; }
    bool looks_at(std::uint32_t px, std::uint32_t py) const {
        const std::uint32_t left = coarse ? x : 0, top = coarse ? y : 0;
        return stride == 0 || ((px - left) % stride == 0 && (py - top) % stride == 0);
    }
    std::uint32_t block() const { return first_sample / samples_per_block; }
    std::uint32_t blocks() const { return (samples + samples_per_block - 1) / samples_per_block; }
    friend bool operator==(const Tile&, const Tile&) = default;
};

static_assert(std::is_trivially_copyable_v<Tile>, "tiles travel as bytes");

/// The samples of a picture are rendered in passes, where nodes learn anew for each: a block of samples is a pass.
inline std::uint32_t pass_of(const Tile& tile) { return tile.block(); }
/// How questions name their pass: never by 0, and alike only for passes that are so many apart.
inline constexpr std::uint32_t pass_marks = 0xffff;
constexpr std::uint16_t mark_of_pass(std::uint32_t pass) { return static_cast<std::uint16_t>(pass % pass_marks + 1); }

/// The work of a tile as one tile for each of its blocks of samples.
std::vector<Tile> one_by_one(const Tile& tile);

}  // namespace lightnet
