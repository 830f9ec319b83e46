// BMP, of Windows and of OS/2: palettes, masks, run lengths, rows from either end.
#include <algorithm>
#include <array>
#include <bit>

#include "core/readers/images/image_bytes.hpp"

namespace lightnet::decoders {
namespace {

constexpr std::size_t bmp_file_header = 14;
enum BmpPacking : std::uint32_t {
    bmp_plain,
    bmp_runs_of_8,
    bmp_runs_of_4,
    bmp_masks,
    bmp_jpeg,
    bmp_png,
    bmp_alpha_masks
};

struct BmpHeader {
    std::int64_t width = 0, height = 0;
    bool from_top = false;
    std::uint32_t bits = 0, packing = bmp_plain, colours = 0, colour_bytes = 4;
    std::size_t palette = 0, pixels = 0;   // where they begin
    std::array<std::uint32_t, 4> masks{};  // red, green, blue, alpha
};

BmpHeader bmp_header(const LowFirst& file) {
    BmpHeader header;
    const std::size_t size = file.four(bmp_file_header), at = bmp_file_header;
    header.pixels = file.four(10);
    header.palette = at + size;
    if (size == 12) {
        header.width = file.two(at + 4), header.height = file.two(at + 6);
        header.bits = file.two(at + 10), header.colour_bytes = 3;
        return header;
    }
    if (size < 16 || size > 65536) file.refuse("its header is of an unknown kind");
    header.width = static_cast<std::int32_t>(file.four(at + 4));
    header.height = static_cast<std::int32_t>(file.four(at + 8));
    header.from_top = header.height < 0;
    header.height = header.from_top ? -header.height : header.height;
    header.bits = file.two(at + 14);
    if (size >= 20) header.packing = file.four(at + 16);
    if (size >= 36) header.colours = file.four(at + 32);
    if (size == 64 && header.packing > bmp_runs_of_4) file.refuse("packing of OS/2 is not supported");
    const bool masked = header.packing == bmp_masks || header.packing == bmp_alpha_masks;
    const bool four = size >= 56 || header.packing == bmp_alpha_masks;
    for (std::size_t i = 0; masked && i < (four ? 4u : 3u); ++i) header.masks[i] = file.four(at + 40 + 4 * i);
    if (masked && size == 40) header.palette += four ? 16 : 12;
    return header;
}

/// Bits of a pixel as a number of 0 to 255.
class BmpMask {
public:
    explicit BmpMask(std::uint32_t mask)
        : mask_(mask), shift_(mask ? std::countr_zero(mask) : 0), most_(std::uint64_t{mask} >> shift_) {}
    std::uint8_t operator()(std::uint32_t pixel) const {
        if (!mask_) return 0;
        return static_cast<std::uint8_t>((((pixel & mask_) >> shift_) * std::uint64_t{255} + most_ / 2) / most_);
    }

private:
    std::uint32_t mask_;
    int shift_;
    std::uint64_t most_;
};

using BmpColour = std::array<std::uint8_t, 3>;

std::vector<BmpColour> bmp_palette(const LowFirst& file, const BmpHeader& header) {
    const std::size_t full = std::size_t{1} << header.bits;
    std::size_t count = header.colours && header.colours < full ? header.colours : full;
    if (header.pixels > header.palette)  // some leave colours away that no pixel has
        count = std::min(count, (header.pixels - header.palette) / header.colour_bytes);
    std::vector<BmpColour> colours(full);
    for (std::size_t i = 0; i < count; ++i) {
        const Input bgr = file.piece(header.palette + i * header.colour_bytes, 3);
        for (std::size_t c = 0; c < 3; ++c) colours[i][c] = std::to_integer<std::uint8_t>(bgr[2 - c]);
    }
    return colours;
}

/// The numbers of the palette, from the lowest row. What is skipped has number 0.
std::vector<std::uint8_t> bmp_unpacked(const LowFirst& file, const BmpHeader& header) {
    const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.height);
    const bool halves = header.packing == bmp_runs_of_4;
    std::vector<std::uint8_t> numbers(width * height);
    std::size_t at = header.pixels, x = 0, y = 0;
    const auto put = [&](std::uint32_t number) {
        if (x < width && y < height) numbers[y * width + x] = static_cast<std::uint8_t>(number);
        ++x;
    };
    const auto half = [](std::uint32_t both, std::size_t i) { return i % 2 ? both & 15 : both >> 4; };
    while (y < height) {
        const std::uint32_t count = file.byte(at), code = file.byte(at + 1);
        at += 2;
        if (count) {
            for (std::size_t i = 0; i < count; ++i) put(halves ? half(code, i) : code);
        } else if (code == 0) {
            x = 0, ++y;
        } else if (code == 1) {
            break;
        } else if (code == 2) {
            x += file.byte(at), y += file.byte(at + 1);
            at += 2;
        } else {
            for (std::size_t i = 0; i < code; ++i) put(halves ? half(file.byte(at + i / 2), i) : file.byte(at + i));
            const std::size_t taken = halves ? (code + 1) / 2 : code;
            at += taken + taken % 2;
        }
    }
    return numbers;
}

Raster bmp_of_palette(const LowFirst& file, const BmpHeader& header) {
    const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.height);
    const auto palette = bmp_palette(file, header);
    const bool packed = header.packing != bmp_plain;
    const auto numbers = packed ? bmp_unpacked(file, header) : std::vector<std::uint8_t>();
    const std::size_t row = (width * header.bits + 31) / 32 * 4, in_byte = 8 / header.bits;
    Raster raster{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 3, false, {}};
    raster.bytes.reserve(width * height * 3);
    for (std::size_t y = 0; y < height; ++y) {
        const std::size_t line = header.from_top ? y : height - 1 - y;
        const Input bytes = packed ? Input() : file.piece(header.pixels + line * row, (width * header.bits + 7) / 8);
        for (std::size_t x = 0; x < width; ++x) {
            const auto shift = (in_byte - 1 - x % in_byte) * header.bits;
            const std::size_t number =
                packed ? numbers[line * width + x]
                       : std::to_integer<std::size_t>(bytes[x / in_byte]) >> shift & ((1u << header.bits) - 1);
            raster.bytes.insert(raster.bytes.end(), palette[number].begin(), palette[number].end());
        }
    }
    return raster;
}

Raster bmp_of_colours(const LowFirst& file, const BmpHeader& header) {
    const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.height);
    auto masks = header.masks;
    if (header.packing == bmp_plain)
        masks = header.bits == 16 ? std::array{0x7C00u, 0x3E0u, 0x1Fu, 0u} : std::array{0xFF0000u, 0xFF00u, 0xFFu, 0u};
    const std::array<BmpMask, 4> parts{BmpMask(masks[0]), BmpMask(masks[1]), BmpMask(masks[2]), BmpMask(masks[3])};
    const std::size_t pixel = header.bits / 8, row = (width * header.bits + 31) / 32 * 4;
    const std::size_t channels = masks[3] ? 4 : 3;
    Raster raster{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), int(channels), false, {}};
    raster.bytes.reserve(width * height * channels);
    for (std::size_t y = 0; y < height; ++y) {
        const std::size_t line = header.pixels + (header.from_top ? y : height - 1 - y) * row;
        for (std::size_t x = 0; x < width; ++x) {
            const auto value = static_cast<std::uint32_t>(file.number(line + x * pixel, pixel));
            for (std::size_t c = 0; c < channels; ++c) raster.bytes.push_back(parts[c](value));
        }
    }
    return raster;
}

}  // namespace

Raster read_bmp(Input bytes) {
    const LowFirst file(bytes, "BMP");
    const BmpHeader header = bmp_header(file);
    if (header.packing == bmp_jpeg || header.packing == bmp_png) {
        const Input inside = file.piece(header.pixels, bytes.size() - std::min(bytes.size(), header.pixels));
        return header.packing == bmp_jpeg ? read_jpeg(inside) : read_png(inside);
    }
    // eight pixels in a byte; run lengths may leave most of them out
    check_size(header.width, header.height, bytes, 1024);
    const bool palette = header.bits == 1 || header.bits == 2 || header.bits == 4 || header.bits == 8;
    const bool runs =
        (header.packing == bmp_runs_of_8 && header.bits == 8) || (header.packing == bmp_runs_of_4 && header.bits == 4);
    const bool masks = header.packing == bmp_masks || header.packing == bmp_alpha_masks;
    if (palette && (header.packing == bmp_plain || runs)) return bmp_of_palette(file, header);
    if ((header.bits == 24 && header.packing == bmp_plain) ||
        ((header.bits == 16 || header.bits == 32) && (header.packing == bmp_plain || masks)))
        return bmp_of_colours(file, header);
    file.refuse("pixels of that kind are not supported");
}

}  // namespace lightnet::decoders
