// Khronos Data Format Specification 1.3, chapters 18 (S3TC) and 19 (RGTC).
#include "core/readers/images/image_blocks.hpp"

#include <algorithm>
#include <array>

namespace lightnet::decoders {
namespace {

using Pixel = std::array<std::uint8_t, 4>;
using Block = std::array<Pixel, 16>;

Pixel colour_of_565(unsigned packed) {
    const unsigned r = packed >> 11, g = packed >> 5 & 63, b = packed & 31;
    const auto whole = [](unsigned value) { return static_cast<std::uint8_t>(value); };
    return {whole(r << 3 | r >> 2), whole(g << 2 | g >> 4), whole(b << 3 | b >> 2), 255};
}

/// The shares of two colours, of three or two parts in all.
Pixel between(const Pixel& a, const Pixel& b, unsigned of_a, unsigned of_b) {
    Pixel made{0, 0, 0, 255};
    const unsigned all = of_a + of_b;
    for (std::size_t i = 0; i < 3; ++i)
        made[i] = static_cast<std::uint8_t>((a[i] * of_a + b[i] * of_b + all / 2) / all);
    return made;
}

/// Two colours, and what lies between them by two bits per pixel. Where the first is not above the second and `three`
/// holds, the last is black, of alpha `none`.
void unpack_colours(const std::uint8_t* from, bool three, std::uint8_t none, Block& to) {
    const unsigned first = from[0] | from[1] << 8, second = from[2] | from[3] << 8;
    std::array<Pixel, 4> colours{colour_of_565(first), colour_of_565(second)};
    if (first > second || !three) {
        colours[2] = between(colours[0], colours[1], 2, 1), colours[3] = between(colours[0], colours[1], 1, 2);
    } else {
        colours[2] = between(colours[0], colours[1], 1, 1), colours[3] = {0, 0, 0, none};
    }
    for (std::size_t i = 0; i < 16; ++i) to[i] = colours[from[4 + i / 4] >> (2 * (i % 4)) & 3];
}

/// Two numbers, and what lies between them by three bits per pixel, into one channel.
void unpack_numbers(const std::uint8_t* from, std::size_t channel, Block& to) {
    const unsigned first = from[0], second = from[1];
    std::array<std::uint8_t, 8> numbers{from[0], from[1], 0, 0, 0, 0, 0, 255};
    const unsigned parts = first > second ? 7 : 5;
    for (unsigned i = 1; i < parts; ++i)
        numbers[i + 1] = static_cast<std::uint8_t>((first * (parts - i) + second * i + parts / 2) / parts);
    std::uint64_t bits = 0;
    for (std::size_t i = 6; i > 0; --i) bits = bits << 8 | from[1 + i];
    for (std::size_t i = 0; i < 16; ++i) to[i][channel] = numbers[bits >> (3 * i) & 7];
}

Block unpacked(Blocks blocks, const std::uint8_t* from) {
    Block to{};
    switch (blocks) {
        case Blocks::bc1:
        case Blocks::bc1_with_alpha:
            unpack_colours(from, true, blocks == Blocks::bc1 ? 255 : 0, to);
            break;
        case Blocks::bc2:
            unpack_colours(from + 8, false, 255, to);
            for (std::size_t i = 0; i < 16; ++i)
                to[i][3] = static_cast<std::uint8_t>((from[i / 2] >> (4 * (i % 2)) & 15) * 17);
            break;
        case Blocks::bc3:
            unpack_colours(from + 8, false, 255, to);
            unpack_numbers(from, 3, to);
            break;
        case Blocks::bc5:
            unpack_numbers(from + 8, 1, to);
            [[fallthrough]];
        case Blocks::bc4:
            unpack_numbers(from, 0, to);
            break;
    }
    return to;
}

}  // namespace

std::vector<std::uint8_t> unpacked_blocks(Blocks blocks, std::span<const std::uint8_t> bytes, std::size_t width,
                                          std::size_t height) {
    std::vector<std::uint8_t> pixels(width * height * 4);
    const std::uint8_t* from = bytes.data();
    for (std::size_t top = 0; top < height; top += 4)
        for (std::size_t left = 0; left < width; left += 4, from += bytes_of_block(blocks)) {
            const Block block = unpacked(blocks, from);
            for (std::size_t y = top; y < std::min(top + 4, height); ++y)
                for (std::size_t x = left; x < std::min(left + 4, width); ++x)
                    std::ranges::copy(block[(y - top) * 4 + x - left],
                                      pixels.begin() + std::ptrdiff_t((y * width + x) * 4));
        }
    return pixels;
}

}  // namespace lightnet::decoders
