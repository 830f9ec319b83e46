// Pixels in blocks of 4 x 4, as graphics cards keep them: BC1 to BC5 (S3TC, RGTC).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lightnet::decoders {

enum class Blocks { bc1, bc1_with_alpha, bc2, bc3, bc4, bc5 };

constexpr std::size_t bytes_of_block(Blocks blocks) {
    return blocks == Blocks::bc1 || blocks == Blocks::bc1_with_alpha || blocks == Blocks::bc4 ? 8 : 16;
}
constexpr std::size_t count_of_blocks(std::size_t width, std::size_t height) {
    return (width + 3) / 4 * ((height + 3) / 4);
}

/// Red, green, blue and alpha of all pixels, row by row; of bc4 red alone counts, of bc5 red and green. `bytes` holds
/// all blocks.
std::vector<std::uint8_t> unpacked_blocks(Blocks blocks, std::span<const std::uint8_t> bytes, std::size_t width,
                                          std::size_t height);

}  // namespace lightnet::decoders
