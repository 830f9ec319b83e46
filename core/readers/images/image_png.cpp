// PNG. libpng reports errors by a function that must not return: it jumps out of the one below, which for that reason
// holds nothing that has a destructor.
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>
#include <string>

#include "core/base/error.hpp"
#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

struct Source {
    Input bytes;
    std::size_t at = 0;
    std::array<char, 128> message{};
};

void read_some(png_structp png, png_bytep into, std::size_t count) {
    auto* source = static_cast<Source*>(png_get_io_ptr(png));
    if (source->bytes.size() - source->at < count) png_error(png, "the file ends early");
    std::memcpy(into, source->bytes.data() + source->at, count);
    source->at += count;
}

void leave(png_structp png, png_const_charp message) {
    auto* source = static_cast<Source*>(png_get_error_ptr(png));
    std::strncpy(source->message.data(), message, source->message.size() - 1);
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

void settle_format(png_structp png, png_infop info) {
    png_set_expand(png);  // palettes, few bits, transparent colours
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
}

/// Two calls: the first, with `rows` empty, finds the size and kind; the second fills the rows.
bool decode(Source& source, Raster& raster, std::vector<png_bytep>& rows) {
    source.at = 0;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, leave, ignore);
    if (!png) return false;
    png_infop info = png_create_info_struct(png);
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_read_struct(&png, info ? &info : nullptr, nullptr);
        return false;
    }
    png_set_read_fn(png, &source, read_some);
    png_read_info(png, info);
    settle_format(png, info);
    raster.width = png_get_image_width(png, info);
    raster.height = png_get_image_height(png, info);
    raster.channels = png_get_channels(png, info);
    raster.wide = png_get_bit_depth(png, info) == 16;
    if (!rows.empty()) {
        png_read_image(png, rows.data());
        png_read_end(png, nullptr);
    }
    png_destroy_read_struct(&png, &info, nullptr);
    return true;
}

}  // namespace

Raster read_png(Input bytes) {
    Raster raster;
    Source source{bytes};
    std::vector<png_bytep> rows;
    const auto must = [&](bool good) {
        if (!good) throw Error("PNG: " + std::string(source.message.data()));
    };
    must(decode(source, raster, rows));
    // deflate makes at most 1032 bytes of one; a palette of two colours has eight pixels in each
    check_size(raster.width, raster.height, bytes, 8 * 1032);
    const std::size_t row_size = std::size_t{raster.width} * raster.channels * (raster.wide ? 2 : 1);
    raster.bytes.resize(row_size * raster.height);
    for (std::size_t y = 0; y < raster.height; ++y) rows.push_back(raster.bytes.data() + y * row_size);
    must(decode(source, raster, rows));
    return raster;
}

}  // namespace lightnet::decoders
