// One decoder per image format; only image_file.cpp chooses among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "core/scene/data/scene_data.hpp"

namespace lightnet::decoders {

using Input = std::span<const std::byte>;

/// Samples as they stand in the file, row by row from the top, not yet linear.
struct Raster {
    std::uint32_t width = 0, height = 0;
    int channels = 3;                 // grey, grey and alpha, RGB, RGB and alpha
    bool wide = false;                // 16 bits per sample instead of 8
    std::vector<std::uint8_t> bytes;  // 16-bit samples: high byte first
};

Raster read_jpeg(Input bytes);
Raster read_png(Input bytes);
/// Does it begin as a TGA may?
bool is_tga(Input bytes);
Raster read_tga(Input bytes);
/// An Image where samples are floats.
std::variant<Raster, Image> read_tiff(Input bytes);
Image read_exr(Input bytes);
Image read_hdr(Input bytes);

/// Throws Error unless an image of that size is worth allocating.
void check_size(std::int64_t width, std::int64_t height);
/// The same before a file is unpacked, of which a byte holds so many pixels at most.
void check_size(std::int64_t width, std::int64_t height, Input file, std::int64_t pixels_per_byte);

}  // namespace lightnet::decoders
