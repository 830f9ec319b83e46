// Colour, transparency and soundness of an image.
#pragma once

#include <string>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Do red, green and blue of any pixel differ?
bool is_coloured(const Image& image);
/// Lets any pixel something through?
bool is_translucent(const Image& image);

/// An image whose numbers can be reckoned with, and what had to be done for that; "": nothing.
struct SoundImage {
    Image image;
    std::string remark{};
};
/// Infinite numbers become the largest of half floats, 65504; what is no number becomes 0.
SoundImage sound(Image image);

}  // namespace lightnet
