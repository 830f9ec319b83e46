// A piece of the picture, and of its samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace lightnet {

/// Samples of a pixel are added up in blocks of this many, and the blocks in the order of their index. Fixed for ever:
/// the bytes of a picture depend on it.
inline constexpr std::uint32_t samples_per_block = 16;

/// One block of samples for a rectangle of pixels: the unit of work of a renderer.
struct Tile {
    std::uint32_t x = 0, y = 0;  // of the upper left pixel, in the picture
    std::uint32_t width = 0, height = 0;
    std::uint32_t first_sample = 0;  // a multiple of samples_per_block
    std::uint32_t samples = 0;       // 1 … samples_per_block
    std::uint32_t stride = 1;        // only pixels whose x and y are multiples of it are wanted (for rehearsals)

    std::size_t pixels() const { return std::size_t{width} * height; }
    std::uint32_t block() const { return first_sample / samples_per_block; }
    friend bool operator==(const Tile&, const Tile&) = default;
};

static_assert(std::is_trivially_copyable_v<Tile>, "tiles travel as bytes");

}  // namespace lightnet
