// Points on a quadric that shines, as they are seen from elsewhere.
#pragma once

#include <optional>

#include "core/base/math/vec.hpp"
#include "core/scene/shapes/placed_quadric.hpp"

namespace lightnet {

/// A quadric, seen from a point. Of whole spheres the points are uniform, in the quadric's own space, within the cone
/// that it fills; of cylinders that shine on one side, where that is seen; else they are uniform by area, in that
/// space, too.
class SeenQuadric {
public:
    SeenQuadric(const PlacedQuadric& quadric, Vec3 from, bool two_sided);

    /// In the quadric's own space.
    Vec3 sample(Vec2 u) const;
    /// Density with which sample() finds a point of it, which lies in `direction`, per steradian.
    float pdf(Vec3 direction, Vec3 own) const;

private:
    enum class Way { cone, arc, area };

    const PlacedQuadric& quadric_;
    const Vec3 from_, own_from_;
    Way way_ = Way::area;
    float drop_ = 0;                // of a cone: 1 - the cosine of its angle
    float middle_ = 0, reach_ = 0;  // of an arc: its angles
};

}  // namespace lightnet
