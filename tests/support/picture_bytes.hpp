// Small pictures as files, one function per format.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lightnet::test {

/// Two pixels beside each other; `format` is one of libpng's PNG_FORMAT_....
std::string png(std::uint32_t format, const void* samples);
/// Two pixels of 8-bit colour.
std::string small_png();
/// 16 x 8 pixels of one value; of 1 or 3 channels.
std::string jpeg(std::uint8_t value, int channels);
/// 3 x 2 pixels of floats in channels of those names.
std::string exr(const std::vector<std::string>& channels);
/// 70 x 50 pixels in tiles of 32 x 32 with smaller levels, as textures are kept; each is {x, y, 1}.
std::string tiled_exr();
/// 20 x 18 pixels, each {x, y, 1}, of 8 or 16 bits or (32) floats in tiles of 16 x 16 or in strips, packed;
/// `apart`: colour by colour.
std::string tiff(int bits, bool tiles, bool apart = false);
/// Two pixels of grey, whose samples are these bytes; `format` as TIFF has it: 1 without a sign, 2 with one, 3 floats.
std::string grey_tiff(int bits, int format, const std::string& samples);
/// Two pixels beside each other, of a palette: red, and a blue that is half of 255; `turned`: how cameras say it was
/// held.
std::string palette_tiff(int turned = 1);
/// Two pixels beside each other by the logarithm of their brightness: two numbers, or X, Y and Z of each.
/// `compression`: 34676 of 32 bits each (16 of grey), 34677 of 24.
std::string log_tiff(int compression, std::vector<float> pixels);
/// 3 x 2 pixels of 32, 24 or 16 bits, or (8) grey: red, green, blue over white, half, black; in runs or not.
std::string tga(int bits, bool packed);
/// Eight pixels of {1, 0.5, 0.25} with run lengths.
std::string hdr();

}  // namespace lightnet::test
