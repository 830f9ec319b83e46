// JPEG. libjpeg reports errors by a function that must not return: it jumps out of the one below, which for that reason
// holds nothing that has a destructor.
#include <cstdio>  // jpeglib.h needs it, and doesn't include it

#include <jerror.h>
#include <jpeglib.h>

#include <array>
#include <csetjmp>
#include <string>

#include "core/base/error.hpp"
#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

struct Errors {
    jpeg_error_mgr base;  // first, so that libjpeg's pointer is ours
    std::jmp_buf jump;
    std::array<char, JMSG_LENGTH_MAX> message;
};

void leave(j_common_ptr jpeg) {
    auto* errors = reinterpret_cast<Errors*>(jpeg->err);
    errors->base.format_message(jpeg, errors->message.data());
    std::longjmp(errors->jump, 1);
}

// libjpeg would fill up an image that ends early with grey; other warnings are harmless
void warn(j_common_ptr jpeg, int level) {
    if (level < 0 && jpeg->err->msg_code == JWRN_JPEG_EOF) leave(jpeg);
}

/// Two calls: the first, with `raster.bytes` empty, finds the size; the second fills the bytes. Four channels are inks,
/// of which `inverted` says that 255 is none.
bool decode(Input bytes, Raster& raster, bool& inverted, Errors& errors) {
    jpeg_decompress_struct jpeg;
    jpeg.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = leave;
    errors.base.emit_message = warn;
    jpeg_create_decompress(&jpeg);
    if (setjmp(errors.jump)) {
        jpeg_destroy_decompress(&jpeg);
        return false;
    }
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
    raster.width = jpeg.image_width;
    raster.height = jpeg.image_height;
    const bool inks = jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK;
    raster.channels = inks ? 4 : 3;
    inverted = jpeg.saw_Adobe_marker;
    if (!raster.bytes.empty()) {
        jpeg.out_color_space = inks ? JCS_CMYK : JCS_RGB;
        // whole numbers give the same pixels on every machine
        jpeg.dct_method = JDCT_ISLOW;
        jpeg_start_decompress(&jpeg);
        while (jpeg.output_scanline < jpeg.output_height) {
            JSAMPROW row = raster.bytes.data() + std::size_t{jpeg.output_scanline} * raster.width * (inks ? 4 : 3);
            jpeg_read_scanlines(&jpeg, &row, 1);
        }
        jpeg_finish_decompress(&jpeg);
    }
    jpeg_destroy_decompress(&jpeg);
    return true;
}

/// Inks as each lets light through, without a colour profile.
void inks_to_colours(Raster& raster, bool inverted) {
    const std::size_t pixels = std::size_t{raster.width} * raster.height;
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto light = [&](std::size_t c) { return raster.bytes[i * 4 + c] ^ (inverted ? 0u : 255u); };
        const unsigned black = light(3);
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned passed = light(c) * black;
            raster.bytes[i * 3 + c] = static_cast<std::uint8_t>((passed + 127) / 255);
        }
    }
    raster.bytes.resize(pixels * 3);
    raster.channels = 3;
}

}  // namespace

Raster read_jpeg(Input bytes) {
    Raster raster;
    Errors errors{};
    bool inverted = false;
    const auto must = [&](bool good) {
        if (!good) throw Error("JPEG: " + std::string(errors.message.data()));
    };
    must(decode(bytes, raster, inverted, errors));
    // a bit or so for each 8 x 8 pixels
    check_size(raster.width, raster.height, bytes, 1024);
    raster.bytes.resize(std::size_t{raster.width} * raster.height * static_cast<std::size_t>(raster.channels));
    must(decode(bytes, raster, inverted, errors));
    if (raster.channels == 4) inks_to_colours(raster, inverted);
    return raster;
}

}  // namespace lightnet::decoders
