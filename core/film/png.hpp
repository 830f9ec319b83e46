// Pictures for looking at.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/film/picture.hpp"

namespace lightnet {

/// How linear radiance becomes 8 bits: for reports and for the user to read.
inline constexpr std::string_view png_tone = "exposure 1, clipped to 0..1, sRGB transfer curve, 8 bits";

/// The bytes of an 8 bit sRGB PNG of the beauty, toned as png_tone says. NaN is black.
std::string png_of(const Picture& picture);

/// What a channel must be at least to get each level from 1 on: so that others may tone exactly alike.
std::array<float, 255> least_of_levels();

/// Writes it, whole or not at all. Throws Error.
void write_png(const std::filesystem::path& path, const Picture& picture);

}  // namespace lightnet
