// Pictures for looking at.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "core/film/picture.hpp"
#include "core/film/tone_curves.hpp"

namespace lightnet {

/// How a PNG shows a picture: so many stops brighter than it is, and by a curve, a view of OpenColorIO, or clipped.
struct PngView {
    double stops = 0;
    Tone tone = Tone::clipped;
    std::string ocio{};  // the view, if that tones it
    bool alpha = false;  // with the picture's alpha, if it has one: colours are then those of what covers the pixel
    friend bool operator==(const PngView&, const PngView&) = default;
};

/// How linear radiance becomes 8 bits: for reports and for the user to read.
std::string tone_of(const PngView& view);

/// What a PNG is packed for: a small file, or one that is there at once.
enum class PngEffort { small, quick };

/// The bytes of an 8 bit sRGB PNG of the beauty, toned as tone_of() says. NaN is black. Where the view has an alpha, so
/// has the PNG: not premultiplied, as its format wants it, so colours are divided by it before they are toned.
std::string png_of(const Picture& picture, const PngView& view = {}, PngEffort effort = PngEffort::small);

/// What a channel must be at least to get each level from 1 on, where there is no other view: so that others may tone
/// exactly alike.
std::array<float, 255> least_of_levels();

/// Writes it, whole or not at all. Throws Error.
void write_png(const std::filesystem::path& path, const Picture& picture, const PngView& view = {});

}  // namespace lightnet
