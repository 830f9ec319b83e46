// The paths of a pixel's samples, drawn over the picture.
#pragma once

#include <cstddef>

#include "core/film/picture.hpp"
#include "tools/explain/pixel_account.hpp"

namespace lightnet {

/// The beauty, darkened and enlarged where it is small, with a frame around the pixel and every ray of its `most`
/// brightest samples: white what the renderer traces, each node's in a colour of its own, dim what is hidden.
Picture path_picture(const Picture& picture, const PixelAccount& account, std::size_t most);

/// Of the node of that number: by name, and as it is drawn.
struct PathColour {
    const char* name;
    Rgb colour;
};
PathColour path_colour(std::size_t node);

}  // namespace lightnet
