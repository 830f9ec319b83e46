// Images read from files, for textures and skies.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// How the numbers of an 8- or 16-bit image stand for light. Images of floats are always linear.
struct Encoding {
    enum class Curve { srgb, linear, gamma };
    Curve curve = Curve::srgb;
    float gamma = 1;  // of Curve::gamma: linear = value^gamma
    friend bool operator==(const Encoding&, const Encoding&) = default;
};

/// Decodes an image; its format is told by its first bytes. Throws Error (without a file name) when it is broken, of
/// no known kind, or has more than 2²⁶ pixels; MissingHere where memory is short.
Image read_image(std::span<const std::byte> bytes, const Encoding& encoding = {});

/// What stands in for an image that can't be read: one pixel that reflects half of the light.
Image mid_grey();

/// Throws Error (without a file name) when a file that begins so is no image of a known kind: said before all of it is
/// read. So much of its beginning tells:
inline constexpr std::size_t image_beginning = 64;
void expect_image(std::span<const std::byte> beginning);

}  // namespace lightnet
