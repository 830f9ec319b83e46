// GIF, with giflib: its first picture.
#include <gif_lib.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "core/base/error.hpp"
#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

struct GifBytes {
    Input bytes;
    std::size_t at = 0;
};

int read_gif_bytes(GifFileType* gif, GifByteType* into, int count) {
    auto& source = *static_cast<GifBytes*>(gif->UserData);
    const auto there = std::min(static_cast<std::size_t>(std::max(0, count)), source.bytes.size() - source.at);
    if (there) std::memcpy(into, source.bytes.data() + source.at, there);
    source.at += there;
    return static_cast<int>(there);
}

struct CloseGif {
    void operator()(GifFileType* gif) const { DGifCloseFile(gif, nullptr); }
};
using OpenGif = std::unique_ptr<GifFileType, CloseGif>;

[[noreturn]] void refuse_gif(int code) {
    const char* why = GifErrorString(code);
    throw Error(std::string("GIF: ") + (why ? why : "the file is broken, or ends early"));
}

void must(const GifFileType& gif, int result) {
    if (result != GIF_OK) refuse_gif(gif.Error);
}

/// Goes on to the first picture. Returns the number of its colour that is none, or -1.
int gif_to_picture(GifFileType& gif) {
    int clear = NO_TRANSPARENT_COLOR;
    for (;;) {
        GifRecordType record = UNDEFINED_RECORD_TYPE;
        must(gif, DGifGetRecordType(&gif, &record));
        if (record == IMAGE_DESC_RECORD_TYPE) {
            must(gif, DGifGetImageHeader(&gif));
            return clear;
        }
        if (record == TERMINATE_RECORD_TYPE) throw Error("GIF: there is no picture in it");
        GifByteType* block = nullptr;
        int kind = 0;
        for (must(gif, DGifGetExtension(&gif, &kind, &block)); block; must(gif, DGifGetExtensionNext(&gif, &block))) {
            GraphicsControlBlock control{};
            if (kind == GRAPHICS_EXT_FUNC_CODE && DGifExtensionToGCB(block[0], block + 1, &control) == GIF_OK)
                clear = control.TransparentColor;
        }
    }
}

/// The rows of a picture in the order of its file.
std::vector<int> gif_rows(int height, bool interlaced) {
    std::vector<int> rows;
    const auto every = [&](int first, int step) {
        for (int y = first; y < height; y += step) rows.push_back(y);
    };
    if (interlaced)
        every(0, 8), every(4, 8), every(2, 4), every(1, 2);
    else
        every(0, 1);
    return rows;
}

}  // namespace

Raster read_gif(Input bytes) {
    GifBytes source{bytes};
    int problem = 0;
    const OpenGif gif(DGifOpen(&source, read_gif_bytes, &problem));
    if (!gif) refuse_gif(problem);
    const int clear = gif_to_picture(*gif);
    const GifImageDesc& part = gif->Image;
    const auto width = std::max<std::int64_t>(gif->SWidth, std::int64_t{part.Left} + part.Width);
    const auto height = std::max<std::int64_t>(gif->SHeight, std::int64_t{part.Top} + part.Height);
    check_size(part.Width, part.Height, bytes, 4096);
    check_size(width, height, bytes, 65'536);
    const ColorMapObject* colours = part.ColorMap ? part.ColorMap : gif->SColorMap;
    if (!colours) throw Error("GIF: its picture has no colours");
    const bool alpha = clear != NO_TRANSPARENT_COLOR || part.Width < width || part.Height < height;
    const std::size_t channels = alpha ? 4 : 3;
    Raster raster{std::uint32_t(width), std::uint32_t(height), int(channels), false, {}};
    raster.bytes.resize(static_cast<std::size_t>(width * height) * channels);
    std::vector<GifPixelType> line(static_cast<std::size_t>(part.Width));
    for (const int y : gif_rows(part.Height, part.Interlace)) {
        must(*gif, DGifGetLine(gif.get(), line.data(), part.Width));
        auto* pixel = raster.bytes.data() + static_cast<std::size_t>((part.Top + y) * width + part.Left) * channels;
        for (const int number : line) {
            if (number >= colours->ColorCount) throw Error("GIF: a pixel has a colour that is not in the palette");
            const GifColorType& colour = colours->Colors[number];
            pixel[0] = colour.Red, pixel[1] = colour.Green, pixel[2] = colour.Blue;
            if (alpha) pixel[3] = number == clear ? 0 : 255;
            pixel += channels;
        }
    }
    return raster;
}

}  // namespace lightnet::decoders
