#include "core/scene/lamps/ball_lamp.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"

namespace lightnet {

SeenBall::SeenBall(const Sphere& ball, Vec3 from)
    : ball_(ball),
      to_center_(ball.center - from),
      distance2_(length_squared(to_center_)),
      inside_(distance2_ <= ball.radius * ball.radius * 1.00001f) {
    if (inside_) return;
    const float sine2 = ball.radius * ball.radius / distance2_;
    drop_ = sine2 / (1 + std::sqrt(std::max(0.0f, 1 - sine2)));
}

Vec3 SeenBall::sample(Vec2 u) const {
    if (inside_) return sphere(u);
    const Vec3 axis = to_center_ / std::sqrt(distance2_);
    const Vec3 ray = Frame::around(axis).to_world(cone(u, drop_));
    // Where the ray meets the sphere; at its rim where rounding lets it pass by.
    const float along = dot(to_center_, ray);
    const Vec3 aside = ray * along - to_center_;
    const float rest = std::max(0.0f, ball_.radius * ball_.radius - length_squared(aside));
    return normalize(aside - ray * std::sqrt(rest));
}

float SeenBall::pdf(Vec3 outwards, Vec3 direction, float distance2, float area) const {
    if (!inside_) return 1 / (2 * pi * drop_);
    return distance2 / (area * std::max(1e-6f, std::fabs(dot(outwards, direction))));
}

}  // namespace lightnet
