// Truevision TGA: of palettes, colours and grey, packed or not. The format has no mark at its beginning, so a header
// that makes sense has to do.
#include <array>
#include <optional>

#include "core/base/error.hpp"
#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

constexpr std::size_t header_size = 18;

struct Header {
    std::size_t behind = 0;  // where what follows begins
    bool packed = false;
    int kind = 0;  // 1: palette, 2: colours, 3: grey
    int bits = 0;  // of a pixel
    std::size_t colours = 0, first_colour = 0;
    int colour_bits = 0;  // of the palette
    std::uint32_t width = 0, height = 0;
    bool alpha = false, from_right = false, from_top = false;
};

unsigned byte_at(Input bytes, std::size_t at) {
    if (at >= bytes.size()) throw Error("TGA: the file ends early");
    return std::to_integer<unsigned>(bytes[at]);
}

unsigned word_at(Input bytes, std::size_t at) { return byte_at(bytes, at) | byte_at(bytes, at + 1) << 8; }

bool is_colour(int bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

// None: it is no TGA.
std::optional<Header> header_of(Input bytes) {
    if (bytes.size() < header_size) return std::nullopt;
    Header header;
    const unsigned palette = byte_at(bytes, 1), kind = byte_at(bytes, 2), flags = byte_at(bytes, 17);
    header.kind = static_cast<int>(kind & 7);
    header.packed = kind & 8;
    header.colours = word_at(bytes, 5), header.first_colour = word_at(bytes, 3);
    header.colour_bits = static_cast<int>(byte_at(bytes, 7));
    header.width = word_at(bytes, 12), header.height = word_at(bytes, 14);
    header.bits = static_cast<int>(byte_at(bytes, 16));
    header.alpha = (flags & 15) > 0, header.from_right = flags & 16, header.from_top = flags & 32;
    header.behind = header_size + byte_at(bytes, 0);
    if (kind > 11 || palette > 1 || flags >= 64 || !header.width || !header.height) return std::nullopt;
    if (header.kind == 1 && (palette != 1 || header.bits != 8 || !is_colour(header.colour_bits))) return std::nullopt;
    if (header.kind == 2 && !is_colour(header.bits)) return std::nullopt;
    if (header.kind == 3 && header.bits != 8) return std::nullopt;
    return header.kind >= 1 && header.kind <= 3 ? std::optional(header) : std::nullopt;
}

/// A pixel or a colour of the palette: blue first, or five bits of each.
struct Colour {
    std::array<std::uint8_t, 4> rgba;
};

Colour colour_at(Input bytes, std::size_t at, int bits) {
    const auto eight = [](unsigned five) { return static_cast<std::uint8_t>((five & 31) * 255 / 31); };
    if (bits <= 16) {
        const unsigned word = word_at(bytes, at);
        return {{eight(word >> 10), eight(word >> 5), eight(word), std::uint8_t(word & 0x8000 ? 255 : 0)}};
    }
    const auto number = [&](std::size_t k) { return static_cast<std::uint8_t>(byte_at(bytes, at + k)); };
    return {{number(2), number(1), number(0), bits == 32 ? number(3) : std::uint8_t{255}}};
}

std::size_t bytes_of(int bits) { return static_cast<std::size_t>(bits + 7) / 8; }

/// Reads pixels one by one, in the file's order.
class Pixels {
public:
    Pixels(Input bytes, const Header& header)
        : bytes_(bytes), header_(header), at_(header.behind + header.colours * bytes_of(header.colour_bits)) {}

    Colour next() {
        if (!header_.packed) return read();
        if (left_ == 0) {
            const unsigned run = byte_at(bytes_, at_++);
            left_ = (run & 127) + 1;
            repeats_ = run & 128;
            if (repeats_) repeated_ = read();
        }
        --left_;
        return repeats_ ? repeated_ : read();
    }

private:
    Colour read() {
        const std::size_t at = at_;
        at_ += bytes_of(header_.bits);
        if (header_.kind == 2) return colour_at(bytes_, at, header_.bits);
        const unsigned value = byte_at(bytes_, at);
        const auto grey = static_cast<std::uint8_t>(value);
        if (header_.kind == 3) return {{grey, grey, grey, 255}};
        if (value < header_.first_colour || value >= header_.first_colour + header_.colours)
            throw Error("TGA: a pixel has a colour that is not in the palette");
        return colour_at(bytes_, header_.behind + (value - header_.first_colour) * bytes_of(header_.colour_bits),
                         header_.colour_bits);
    }

    Input bytes_;
    const Header& header_;
    std::size_t at_;
    unsigned left_ = 0;  // of a run
    bool repeats_ = false;
    Colour repeated_{};
};

}  // namespace

bool is_tga(Input bytes) { return header_of(bytes).has_value(); }

Raster read_tga(Input bytes) {
    const Header header = *header_of(bytes);
    check_size(header.width, header.height);
    const std::size_t pixels = std::size_t{header.width} * header.height;
    // Before memory is taken: a run of 128 pixels takes two bytes at least.
    if (bytes.size() < header.behind || (bytes.size() - header.behind) * 64 < pixels)
        throw Error("TGA: the file ends early");
    Raster raster;
    raster.width = header.width, raster.height = header.height;
    const bool alpha = header.alpha && (header.kind == 1 ? header.colour_bits : header.bits) % 16 == 0;
    raster.channels = header.kind == 3 ? 1 : alpha ? 4 : 3;
    const auto channels = static_cast<std::size_t>(raster.channels);
    raster.bytes.resize(pixels * channels);
    Pixels source(bytes, header);
    for (std::size_t row = 0; row < header.height; ++row)
        for (std::size_t column = 0; column < header.width; ++column) {
            const std::size_t y = header.from_top ? row : header.height - 1 - row;
            const std::size_t x = header.from_right ? header.width - 1 - column : column;
            const Colour colour = source.next();
            for (std::size_t c = 0; c < channels; ++c)
                raster.bytes[(y * header.width + x) * channels + c] = colour.rgba[c];
        }
    return raster;
}

}  // namespace lightnet::decoders
