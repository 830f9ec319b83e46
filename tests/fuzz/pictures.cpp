#include "core/base/error.hpp"
#include "core/readers/image_file.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/picture_bytes.hpp"

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
            std::string("#?RGBE\n\n-Y 1 +X 4\n") + std::string("\x80\x40\x20\x81\x01\x01\x01\x03", 8)};
}

}  // namespace

Target pictures() { return {"pictures", read, seeds}; }

}  // namespace lightnet::fuzz
