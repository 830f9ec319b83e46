// One decoder per image format; only image_file.cpp chooses among them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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

/// A Raster of whole numbers, or an Image of floats.
using Found = std::variant<Raster, Image>;

Raster read_bmp(Input bytes);
Image read_exr(Input bytes);
/// The first picture of several.
Raster read_gif(Input bytes);
Image read_hdr(Input bytes);
Raster read_jpeg(Input bytes);
Found read_ktx(Input bytes);
/// PBM, PGM, PPM and PAM.
Raster read_netpbm(Input bytes);
Image read_pfm(Input bytes);
Raster read_png(Input bytes);
/// Does it begin as a TGA may?
bool is_tga(Input bytes);
Raster read_tga(Input bytes);
Found read_tiff(Input bytes);
/// The first picture of several.
Raster read_webp(Input bytes);

/// Throws Error unless an image of that size is worth allocating.
void check_size(std::int64_t width, std::int64_t height);
/// Throws Error unless an image of that size is worth allocating, before a file is unpacked of which a byte holds so
/// many pixels at most.
void check_size(std::int64_t width, std::int64_t height, Input file, std::int64_t pixels_per_byte);

/// Where colours lie that are given by red, green and blue: CIE 1931 x and y.
struct Primaries {
    using Place = std::array<double, 2>;
    Place red, green, blue, white;
};
inline constexpr Primaries rec709{{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3127, 0.329}};
inline constexpr Primaries cie_xyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};

/// Turns linear colours of those primaries into ours (Rec. 709, white D65): white stays white, by Bradford's matrix; X,
/// Y and Z stay the light that they are. What ours can't show is cut at 0. Primaries that span no colours count as
/// ours.
void turn_to_ours(const Primaries& from, std::vector<Rgb>& pixels);

/// A picture of latitude and longitude, as OpenEXR lays it out (ImfEnvmap.h), of the six faces of a cube that stand
/// below each other: `size` x 6 `size` pixels.
Image from_cube(std::size_t size, const std::vector<Rgb>& pixels, const std::vector<float>& alpha);

}  // namespace lightnet::decoders
