// Cleaned frames of a sequence, made quieter by those beside them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/film/picture.hpp"

namespace lightnet {

/// Why a cleaned picture can't be joined with those beside it; "": it can.
std::string fault_across(const Picture& cleaned);

/// The cleaned frame with number `which` of some in a row, joined with the others of them: each looks up its points
/// where the vectors to the next frame (SurfaceFact { of = "motion" }) lead, backwards where that is the way. How much
/// a frame counts at a pixel is the same for all its layers, so sums stay sums: by how alike 3 x 3 pixels of both are,
/// in parts of what each is expected to be off by ("clean_error"). What is further apart than that hardly counts, as
/// where something comes into view. Gains change no weight.
///
/// What is expected of the error is told anew: of noise that frames have in common, as those of one seed do where
/// nothing moves, nothing is taken away. Same bytes on any machine and any number of threads. Frames that have another
/// size or other layers are left out, and so is what lies behind a frame that is missing.
Picture joined_across(const std::map<int, Picture>& frames, int which);

}  // namespace lightnet
