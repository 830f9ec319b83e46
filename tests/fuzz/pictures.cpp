#include "core/base/error.hpp"
#include "core/readers/images/image_file.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/picture_bytes.hpp"
#include "tests/support/picture_kinds.hpp"

namespace lightnet::fuzz {
namespace {

void read(std::span<const std::byte> bytes) {
    try {
        (void)read_image(bytes);
    } catch (const Error&) {
    }
}

std::vector<std::string> seeds() {
    return {test::small_png(),
            test::jpeg(100, 3),
            test::jpeg(100, 1),
            test::exr({"R", "G", "B", "A"}),
            test::exr({"Y"}),
            test::hdr(),
            test::tiff(8, false),
            test::tiff(16, true),
            test::tiff(32, true),
            test::palette_tiff(),
            test::tga(16, false),
            test::tga(32, true),
            std::string("#?RGBE\n\n-Y 1 +X 4\n") + std::string("\x80\x40\x20\x81\x01\x01\x01\x03", 8),
            std::string("#?RADIANCE\nFORMAT=32-bit_rle_xyze\nEXPOSURE=2\nCOLORCORR=1 2 4\n\n-X 2 +Y 2\n") +
                std::string("\x80\x40\x20\x81\x01\x01\x01\x03", 8)};
}

// Of a target of their own, so that each is tried as often.
std::vector<std::string> seeds_of_rarer_kinds() {
    std::vector<std::string> all{
        test::pfm(true, -1),
        test::pfm(false, 2),
        test::gif(false),
        test::gif(true),
        test::cmyk_jpeg(10, 100, 50, 20, true),
        test::cmyk_jpeg(10, 100, 50, 20, false),
        test::tiled_exr().substr(0, 2000),
        test::windowed_exr({.data = {-2, -1, 1, 0}, .chromaticities = {1, 0, 0, 1, 0, 0, .3f, .3f}}),
        test::windowed_exr({.channels = {"left.R", "left.G", "left.B", "left.A"}}),
        test::chroma_exr(1, 0.5f, 0.25f),
        test::parts_exr()};
    for (const bool packed : {false, true})
        for (const int bits : {4, 8, 16, 32}) all.push_back(test::bmp(bits, packed, packed));
    all.push_back(test::bmp(1, true, false));
    for (char kind = '1'; kind <= '7'; ++kind) all.push_back(test::netpbm(kind, kind == '6' ? 1000 : 255));
    for (const bool lossless : {false, true})
        for (const bool alpha : {false, true}) all.push_back(test::webp(lossless, alpha));
    for (const std::uint32_t packing : {0u, 2u, 3u})
        all.push_back(test::ktx({.packing = packing, .keys = std::string("\x12\0\0\0KTXorientation\0ru\0\0\0", 24)},
                                std::string(18, 'x')));
    all.push_back(test::ktx({.format = 97, .width = 1, .height = 1}, std::string(8, 'x')));
    for (const std::uint32_t blocks : {131u, 133u, 135u, 137u, 139u, 141u})
        all.push_back(test::ktx({.format = blocks, .width = 5, .height = 3}, std::string(32, 'x')));
    return all;
}

}  // namespace

Target pictures() { return {"pictures", read, seeds}; }
Target rare_pictures() { return {"rare_pictures", read, seeds_of_rarer_kinds}; }

}  // namespace lightnet::fuzz
