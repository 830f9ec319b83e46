// The paths of a pixel's samples, drawn over the picture.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/math/vec.hpp"
#include "core/film/picture.hpp"
#include "tools/explain/pixel_account.hpp"

namespace lightnet {

/// A ray as the eye sees it, in pixels of the whole picture, across and down; it may reach beyond the picture, and
/// begins or ends where it would pass behind the eye.
struct PathLine {
    Vec2 from, to;
    std::size_t node = 0;  // whose it is; AskedQuestion::nobody: the renderer's
    bool hidden = false;
};
/// Those of its `most` brightest samples, the brightest last. Any thread.
std::vector<PathLine> path_lines(const PixelAccount& account, std::size_t most);

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
