// Transforms between transforms, for what moves in files.
#pragma once

#include <array>
#include <span>

#include "core/base/math/transform.hpp"

namespace lightnet {

/// A turn: x, y, z, w; of any length but 0.
using Quaternion = std::array<double, 4>;

/// Evenly from one turn (t = 0) to the other (t = 1) on the shorter way. Both are unit, and so is the result.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double t);

/// From one affine transform to another, each taken apart into a move, a turn and what it stretches, of which turns go
/// by slerp() and the others evenly: Shoemake & Duff 1992. What can't be taken apart, as it has no inverse, goes evenly
/// as a whole.
Matrix between(const Matrix& a, const Matrix& b, double t);

/// A transform and when it is there.
struct TransformKey {
    double seconds = 0;
    Matrix transform;
};
/// That of a moment, by keys in the order of time; the first before it, the last after it. Keys are not empty.
Matrix transform_at(std::span<const TransformKey> keys, double seconds);

}  // namespace lightnet
