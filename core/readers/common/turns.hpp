// Turns of lamps: what a transform turns, and how luminaires hang.
#pragma once

#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// What the transform turns, and perhaps mirrors, without what it moves and stretches.
Matrix turn_of(const Matrix& transform);

/// Turns a luminaire's own axes, whose straight down is -z, so that it shines along `down` (unit).
Matrix hung(Vec3 down);

}  // namespace lightnet
