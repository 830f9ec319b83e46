// Names of files that stand for many: one for each frame of a sequence.
#pragma once

#include <string>
#include <string_view>

namespace lightnet {

/// Is there a place for the number of a frame: "shot.####.exr", or "shot.%04d.exr"?
bool has_frame_place(std::string_view name);

/// The name with the number in that place, in so many digits at least; a name without a place stays as it is.
std::string with_frame(std::string_view name, int frame);

/// The name without it, and without what parts it from the rest: "shot.####.exr" → "shot.exr".
std::string without_frame_place(std::string_view name);

/// What names have there that stand for any frame: "shot.0017.exr" → "shot.####.exr"; "": there is no number.
std::string frame_place_for(std::string_view name);

}  // namespace lightnet
