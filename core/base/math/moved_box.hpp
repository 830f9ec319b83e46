// Boxes that are moved.
#pragma once

#include "core/base/math/box.hpp"
#include "core/base/math/transform.hpp"

namespace lightnet {

/// One of a box's eight corners.
inline Vec3 corner_of(const Box& box, int corner) {
    return {corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
            corner & 4 ? box.high.z : box.low.z};
}

/// Grows `to` around what may lie in a box, once it is moved. An empty one adds nothing.
inline void add_moved(Box& to, const Box& box, const Matrix& by) {
    if (box.empty()) return;
    for (int corner = 0; corner < 8; ++corner) to.add(transform_point(by, corner_of(box, corner)));
}

}  // namespace lightnet
