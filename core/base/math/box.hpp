// The box around some points, its sides along the axes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/base/math/vec.hpp"

namespace lightnet {

/// Grows with each point; empty to begin with.
struct Box {
    static constexpr float far = std::numeric_limits<float>::infinity();
    Vec3 low{far, far, far}, high{-far, -far, -far};

    void add(Vec3 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    bool empty() const { return !(low.x <= high.x); }
    Vec3 center() const { return (low + high) * 0.5f; }
    Vec3 size() const { return high - low; }
    /// Of its sides; the first of equal ones.
    std::size_t longest_axis() const {
        const Vec3 sides = size();
        return sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    }
};

}  // namespace lightnet
