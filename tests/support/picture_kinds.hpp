// Small pictures of the rarer kinds, as files. Where nothing else is said they show red, green and blue beside each
// other, and below them white, grey (128) and black.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lightnet::test {

struct Wheel {
    static constexpr std::uint32_t width = 3, height = 2;
    /// Bytes of RGB or RGBA, from the top; half opaque is the blue pixel.
    static std::vector<std::uint8_t> bytes(int channels);
};

/// `bits`: 1 (white and black alone), 4, 8, 16, 24 or 32; `from_top`: by a negative height; `packed`: by run lengths,
/// of 8 and 4 bits, or by masks.
std::string bmp(int bits, bool from_top, bool packed);
/// '1' to '7'; `most`: the number of white.
std::string netpbm(char kind, unsigned most = 255);
/// Linear: as 1, 0 and 128 / 255. A negative `scale`: the low byte comes first.
std::string pfm(bool colours, float scale);
std::string webp(bool lossless, bool alpha);
/// Its blue pixel is transparent.
std::string gif(bool interlaced);
/// Of one colour everywhere, 8 x 8 pixels, by inks; `adobe`: with the marker of those that write them inverted.
std::string cmyk_jpeg(std::uint8_t c, std::uint8_t m, std::uint8_t y, std::uint8_t k, bool adobe);

/// Its numbers as they are to stand there, of a level of that size; `packing`: 0 none, 2 zstd, 3 deflate.
struct Ktx {
    std::uint32_t format = 29, width = Wheel::width, height = Wheel::height, packing = 0;
    std::string keys{};  // "KTXorientation\0ru\0" and the like, each with its length in front
};
std::string ktx(const Ktx& ktx, const std::string& level);

/// Four floats: x and y.
struct ExrPicture {
    std::vector<std::string> channels{"R", "G", "B"};
    int data[4] = {0, 0, 2, 1}, display[4] = {0, 0, 2, 1};  // left, top, right, bottom
    std::vector<float> chromaticities{};                    // red, green, blue, white: x and y of each
    std::optional<int> envmap{};                            // the attribute: 0 latitude and longitude, 1 a cube
};
/// The channel number c has, at each pixel of the data, 100 * y + x + c / 8.
std::string windowed_exr(const ExrPicture& picture);
/// One colour everywhere, by brightness and fewer colours.
std::string chroma_exr(float red, float green, float blue);
/// The six faces of a cube, whose red, green and blue are 2 + the direction to +x, +y and +z; `tiled`: with all smaller
/// levels.
std::string cube_exr(int size, bool tiled);
/// Two parts: the first has only Z, the second R, G and B as above.
std::string parts_exr();

}  // namespace lightnet::test
