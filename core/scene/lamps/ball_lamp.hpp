// A ball that shines, as it is seen from a point.
#pragma once

#include "core/base/math/vec.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Finds directions to a ball: uniformly within the cone that it fills, seen from outside; by points that are uniform
/// by area, seen from inside. A value.
class SeenBall {
public:
    SeenBall(const Sphere& ball, Vec3 from);

    /// Where on the ball: its unit normal there, outwards.
    Vec3 sample(Vec2 u) const;
    /// Density with which sample() finds the `direction` to what has this normal `outwards`, at `distance2` (squared),
    /// per steradian. `area`: of the whole ball.
    float pdf(Vec3 outwards, Vec3 direction, float distance2, float area) const;

private:
    const Sphere& ball_;
    Vec3 to_center_;
    float distance2_;
    bool inside_;
    float drop_ = 0;  // 1 - cos of half the cone's angle; without cancellation for small ones
};

}  // namespace lightnet
