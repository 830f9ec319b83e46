// A ball that shines, as it is seen from a point.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/math/frame.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/shapes/ball.hpp"

namespace lightnet {

/// Finds directions to a ball: uniformly within the cone that it fills, seen from outside; by points that are uniform
/// by area, seen from inside. Without a branch, as loops over many points want it. A value.
class SeenBall {
public:
    [[gnu::always_inline]] SeenBall(Vec3 center, float radius, Vec3 from)
        : radius2_(radius * radius),
          to_center_(center - from),
          distance2_(length_squared(to_center_)),
          inside_(distance2_ <= radius2_ * 1.00001f) {
        const float sine2 = radius2_ / distance2_;
        drop_ = inside_ ? 2 : sine2 / (1 + std::sqrt(std::max(0.0f, 1 - sine2)));
    }

    /// Where on the ball: its unit normal there, outwards.
    [[gnu::always_inline]] Vec3 sample(Vec2 u) const {
        const Vec3 to = to_center_ / std::sqrt(distance2_);
        const Vec3 axis{inside_ ? 0 : to.x, inside_ ? 0 : to.y, inside_ ? 1 : to.z};
        const Vec3 ray = Frame::around(axis).to_world(cone(u, drop_));
        // Where the ray meets the sphere; at its rim where rounding lets it pass by.
        const float along = dot(to_center_, ray);
        const Vec3 aside = ray * along - to_center_;
        const float rest = std::max(0.0f, radius2_ - length_squared(aside));
        const Vec3 met = normalize(aside - ray * std::sqrt(rest));
        return {inside_ ? ray.x : met.x, inside_ ? ray.y : met.y, inside_ ? ray.z : met.z};
    }
    /// Density with which sample() finds the `direction` to what has this normal `outwards`, at `distance2` (squared),
    /// per steradian. `area`: of the whole ball.
    [[gnu::always_inline]] float pdf(Vec3 outwards, Vec3 direction, float distance2, float area) const {
        const float by_area = distance2 / (area * std::max(1e-6f, std::fabs(dot(outwards, direction))));
        return inside_ ? by_area : 1 / (2 * pi * drop_);
    }

private:
    float radius2_;
    Vec3 to_center_;
    float distance2_;
    bool inside_;
    float drop_;  // 1 - cos of half the cone's angle; without cancellation for small ones. Inside: of the whole sphere
};

/// One that emits the same radiance everywhere.
struct BallLamp {
    Vec3 center;
    float radius = 0, area = 0;  // m, m²
    Rgb radiance;
    bool inwards = false;  // its normals
    bool two_sided = false;
    std::uint32_t group = 0;
};

/// From a point that is lit to one that was chosen on a ball. As direction_to_lamp(). `position`: off the ball, where
/// the lit point is to be seen.
struct WayToBall {
    Vec3 outwards, position, direction;
    float pdf;
    bool found;
};
[[gnu::always_inline]] inline WayToBall way_to_ball(const BallLamp& ball, Vec3 from, Vec2 u) {
    const SeenBall seen(ball.center, ball.radius, from);
    const Vec3 outwards = seen.sample(u);
    const Vec3 position = on_ball(ball.center, ball.radius, outwards), way = position - from;
    const float way2 = length_squared(way);
    const Vec3 direction = way / std::sqrt(way2);
    const float away = dot(outwards, direction), towards = ball.inwards ? away : -away;
    const float offset = offset_at(position, outwards, ball_offset(ball.radius));
    return {outwards, off_surface(position, outwards, offset, -direction), direction,
            seen.pdf(outwards, direction, way2, ball.area), bool((way2 > 0) & (ball.two_sided | (towards > 0)))};
}

}  // namespace lightnet
