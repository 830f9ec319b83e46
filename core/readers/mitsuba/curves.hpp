// Mitsuba's files of curves.
#pragma once

#include <string_view>

#include "core/base/math/transform.hpp"
#include "core/scene/shapes/curves.hpp"

namespace lightnet::mitsuba {

/// The strands of a text: "x y z radius" on a line, an empty one after each strand. As in Mitsuba, `to_world` moves
/// points and leaves radii as they are. `linear`: straight from point to point, else cubic B-splines. Throws Error with
/// the line, but without a file name, where the text is not sound.
Curves read_curves(std::string_view text, bool linear, const Matrix& to_world);

}  // namespace lightnet::mitsuba
