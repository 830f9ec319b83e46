// KTX 2: plain pixels and blocks of BC1 to BC5, also packed by zstd or deflate; of several levels, layers and faces the
// first.
#include <half.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string>
#include <string_view>

#include "core/readers/images/image_blocks.hpp"
#include "core/readers/images/image_bytes.hpp"

namespace lightnet::decoders {
namespace {

enum class KtxNumber { bytes, words, halves, floats };

/// One of Vulkan's formats.
struct KtxFormat {
    std::uint32_t number;
    std::size_t channels;
    KtxNumber of = KtxNumber::bytes;
    bool blue_first = false;
    std::optional<Blocks> blocks{};  // which become bytes of four channels, of which `channels` count
    std::size_t pixel() const { return channels * (of == KtxNumber::bytes ? 1 : of == KtxNumber::floats ? 4 : 2); }
};

constexpr KtxFormat of_blocks(std::uint32_t number, std::size_t channels, Blocks blocks) {
    return {number, channels, KtxNumber::bytes, false, blocks};
}

constexpr std::array ktx_formats{KtxFormat{9, 1},
                                 KtxFormat{15, 1},
                                 KtxFormat{16, 2},
                                 KtxFormat{22, 2},  // UNORM, SRGB
                                 KtxFormat{23, 3},
                                 KtxFormat{29, 3},
                                 KtxFormat{37, 4},
                                 KtxFormat{43, 4},  //
                                 KtxFormat{30, 3, KtxNumber::bytes, true},
                                 KtxFormat{36, 3, KtxNumber::bytes, true},  // B8G8R8
                                 KtxFormat{44, 4, KtxNumber::bytes, true},
                                 KtxFormat{50, 4, KtxNumber::bytes, true},  //
                                 KtxFormat{70, 1, KtxNumber::words},
                                 KtxFormat{77, 2, KtxNumber::words},  // UNORM
                                 KtxFormat{84, 3, KtxNumber::words},
                                 KtxFormat{91, 4, KtxNumber::words},  //
                                 KtxFormat{76, 1, KtxNumber::halves},
                                 KtxFormat{83, 2, KtxNumber::halves},  // SFLOAT
                                 KtxFormat{90, 3, KtxNumber::halves},
                                 KtxFormat{97, 4, KtxNumber::halves},  //
                                 KtxFormat{100, 1, KtxNumber::floats},
                                 KtxFormat{103, 2, KtxNumber::floats},  //
                                 KtxFormat{106, 3, KtxNumber::floats},
                                 KtxFormat{109, 4, KtxNumber::floats},
                                 of_blocks(131, 3, Blocks::bc1),
                                 of_blocks(132, 3, Blocks::bc1),  // UNORM, SRGB
                                 of_blocks(133, 4, Blocks::bc1_with_alpha),
                                 of_blocks(134, 4, Blocks::bc1_with_alpha),
                                 of_blocks(135, 4, Blocks::bc2),
                                 of_blocks(136, 4, Blocks::bc2),
                                 of_blocks(137, 4, Blocks::bc3),
                                 of_blocks(138, 4, Blocks::bc3),
                                 of_blocks(139, 1, Blocks::bc4),
                                 of_blocks(141, 2, Blocks::bc5)};

enum KtxPacking : std::uint32_t { ktx_plain, ktx_basis, ktx_zstd, ktx_deflate };

struct KtxHeader {
    KtxFormat format{};
    std::uint32_t width = 0, height = 0, packing = 0;
    std::uint64_t level = 0, level_size = 0, unpacked_size = 0;
    bool from_bottom = false;
    std::string swizzle;
    std::size_t pixels() const { return std::size_t{width} * height; }
    std::size_t bytes() const {
        return format.blocks ? count_of_blocks(width, height) * bytes_of_block(*format.blocks)
                             : pixels() * format.pixel();
    }
};

/// The text that stands under that key; "": none.
std::string ktx_text(const LowFirst& file, std::string_view key) {
    const std::size_t first = file.four(56), end = first + std::size_t{file.four(60)};
    for (std::size_t at = first; at + 4 < end;) {
        const std::size_t length = file.four(at);
        const Input piece = file.piece(at + 4, length);
        const std::string_view both(reinterpret_cast<const char*>(piece.data()), piece.size());
        if (both.size() > key.size() && both.starts_with(key) && both[key.size()] == '\0') {
            const auto value = both.substr(key.size() + 1);
            return std::string(value.substr(0, value.find('\0')));
        }
        at += 4 + (length + 3) / 4 * 4;
    }
    return "";
}

KtxHeader ktx_header(const LowFirst& file) {
    KtxHeader header;
    const std::uint32_t number = file.four(12);
    header.packing = file.four(44);
    if (header.packing == ktx_basis || number == 0)
        file.refuse(
            "pixels packed by Basis Universal are not read, as no library for them is packaged; plain pixels are");
    const auto* format = std::ranges::find(ktx_formats, number, &KtxFormat::number);
    if (format == ktx_formats.end())
        file.refuse("pixels of Vulkan's format " + std::to_string(number) +
                    " are not supported (8, 16 and 32 bits and BC1 to BC5 are)");
    if (header.packing > ktx_deflate) file.refuse("packing " + std::to_string(header.packing) + " is not supported");
    header.format = *format;
    header.width = file.four(20), header.height = std::max(1u, file.four(24));
    header.level = file.eight(80), header.level_size = file.eight(88), header.unpacked_size = file.eight(96);
    const std::string turned = ktx_text(file, "KTXorientation");
    header.from_bottom = turned.size() > 1 && turned[1] == 'u';
    header.swizzle = ktx_text(file, "KTXswizzle");
    return header;
}

/// The bytes of the largest level, of which the first picture is wanted.
std::vector<std::uint8_t> ktx_level(const LowFirst& file, const KtxHeader& header) {
    const Input packed = file.piece(header.level, header.level_size);
    const std::size_t wanted = header.bytes();
    std::vector<std::uint8_t> bytes;
    if (header.packing == ktx_plain) {
        if (packed.size() < wanted) file.refuse("the file ends early");
        const auto* first = reinterpret_cast<const std::uint8_t*>(packed.data());
        bytes.assign(first, first + wanted);
        return bytes;
    }
    constexpr std::uint64_t most = std::uint64_t{1} << 31, most_of_a_byte = 50'000;  // zstd's blocks of one byte each
    if (header.unpacked_size < wanted || header.unpacked_size > std::min(most, packed.size() * most_of_a_byte))
        file.refuse("its level is of a wrong size");
    bytes.resize(header.unpacked_size);
    std::size_t made = 0;
    if (header.packing == ktx_zstd) {
        made = ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
    } else {
        uLongf size = bytes.size();
        const auto* from = reinterpret_cast<const Bytef*>(packed.data());
        if (uncompress(bytes.data(), &size, from, packed.size()) == Z_OK) made = size;
    }
    if (made != bytes.size()) file.refuse("its pixels can't be unpacked");
    return bytes;
}

/// What the numbers of a pixel are: two are red and green, unless the file says that they are grey and alpha.
struct KtxMeaning {
    bool grey = false, alpha = false;
    explicit KtxMeaning(const KtxHeader& header)
        : grey(header.format.channels == 1 || (header.format.channels == 2 && header.swizzle == "rrrg")),
          alpha(header.format.channels == 4 || (header.format.channels == 2 && grey)) {}
    std::size_t channels() const { return (grey ? 1u : 3u) + (alpha ? 1u : 0u); }
};

constexpr std::size_t ktx_nowhere = ~std::size_t{0};

/// Hands on where each number of the picture begins in `bytes`, pixel by pixel from the top; nowhere: it is 0.
template <class Take>
void each_ktx_number(const KtxHeader& header, const KtxMeaning& meaning, Take take) {
    const std::size_t given = header.format.channels, size = header.format.pixel() / given, width = header.width;
    const std::size_t step = header.format.blocks ? 4 : header.format.pixel();
    for (std::size_t i = 0; i < header.pixels(); ++i) {
        const std::size_t row = i / width, y = header.from_bottom ? header.height - 1 - row : row;
        const std::size_t pixel = (y * width + i % width) * step;
        for (std::size_t c = 0; c < meaning.channels(); ++c) {
            const std::size_t which = header.format.blue_first && c < 3 ? 2 - c : c;
            take(which < given ? pixel + which * size : ktx_nowhere);
        }
    }
}

Raster ktx_raster(const KtxHeader& header, const KtxMeaning& meaning, const std::vector<std::uint8_t>& bytes) {
    const bool wide = header.format.of == KtxNumber::words;
    Raster raster{header.width, header.height, int(meaning.channels()), wide, {}};
    raster.bytes.reserve(header.pixels() * meaning.channels() * (wide ? 2 : 1));
    each_ktx_number(header, meaning, [&](std::size_t at) {
        if (wide) raster.bytes.push_back(at == ktx_nowhere ? std::uint8_t{0} : bytes[at + 1]);
        raster.bytes.push_back(at == ktx_nowhere ? std::uint8_t{0} : bytes[at]);
    });
    return raster;
}

Image ktx_image(const KtxHeader& header, const KtxMeaning& meaning, const std::vector<std::uint8_t>& bytes) {
    std::vector<float> numbers;
    numbers.reserve(header.pixels() * meaning.channels());
    const LowFirst raw(std::as_bytes(std::span(bytes)), "KTX");
    each_ktx_number(header, meaning, [&](std::size_t at) {
        if (at == ktx_nowhere) return numbers.push_back(0);
        if (header.format.of == KtxNumber::floats) return numbers.push_back(std::bit_cast<float>(raw.four(at)));
        half value;
        value.setBits(static_cast<std::uint16_t>(raw.two(at)));
        numbers.push_back(float(value));
    });
    std::vector<Rgb> pixels;
    std::vector<float> alpha;
    for (auto number = numbers.begin(); number != numbers.end(); number += std::ptrdiff_t(meaning.channels())) {
        pixels.push_back(meaning.grey ? Rgb{number[0], number[0], number[0]} : Rgb{number[0], number[1], number[2]});
        if (meaning.alpha) alpha.push_back(number[std::ptrdiff_t(meaning.channels()) - 1]);
    }
    return {header.width, header.height, pixels, alpha};
}

}  // namespace

Found read_ktx(Input bytes) {
    const LowFirst file(bytes, "KTX");
    const KtxHeader header = ktx_header(file);
    check_size(header.width, header.height);
    const KtxMeaning meaning(header);
    auto level = ktx_level(file, header);
    if (header.format.blocks) level = unpacked_blocks(*header.format.blocks, level, header.width, header.height);
    const bool whole = header.format.of == KtxNumber::bytes || header.format.of == KtxNumber::words;
    if (whole) return ktx_raster(header, meaning, level);
    return ktx_image(header, meaning, level);
}

}  // namespace lightnet::decoders
