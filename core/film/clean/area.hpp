// Cleans one area of a picture.
#pragma once

#include <vector>

#include "core/film/clean/guide.hpp"
#include "core/film/clean/local_fit.hpp"
#include "core/film/picture.hpp"

namespace lightnet::cleaning {

/// What a pixel is expected to be off by, squared, in parts of value² + 0.01, over its surroundings: all of it, which
/// is known so roughly that it may be below 0, and what of it is noise that was left.
struct SquaredError {
    float all = 0, variance = 0;
};

/// Makes what is cleaned of an area's core: the area that begins `rim` to the left of and above `core`. Writes the
/// pixels of that core to all layers of `clean`, and their expected errors; others may be written meanwhile. `halves`:
/// of the layers of `noisy`, in the same order; null: there are none. Scratch of some MB for each layer is its own.
void clean_area(const Picture& noisy, const std::vector<const PictureLayer*>& halves, const Guide& guide, Place core,
                Picture& clean, std::vector<SquaredError>& expected);

}  // namespace lightnet::cleaning
