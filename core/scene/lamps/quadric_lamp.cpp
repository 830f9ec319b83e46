#include "core/scene/lamps/quadric_lamp.hpp"

#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

constexpr float just_outside = 1.00001f;  // of a unit sphere or cylinder, squared: nearer is taken for inside

}  // namespace

SeenQuadric::SeenQuadric(const PlacedQuadric& quadric, Vec3 from, bool two_sided)
    : quadric_(quadric), from_(from), own_from_(quadric.point_to_own(from)) {
    if (!quadric.whole()) return;
    const auto round = quadric.quadric().round;
    const float around2 = own_from_.x * own_from_.x + own_from_.y * own_from_.y;
    if (round == Quadric::Round::sphere) {
        const float sine2 = 1 / (around2 + own_from_.z * own_from_.z);
        if (sine2 * just_outside >= 1) return;
        way_ = Way::cone;
        drop_ = sine2 / (1 + std::sqrt(1 - sine2));
    } else if (round == Quadric::Round::cylinder && !two_sided && around2 > just_outside) {
        way_ = Way::arc;
        middle_ = std::atan2(own_from_.y, own_from_.x);
        reach_ = std::acos(1 / std::sqrt(around2));
        if (quadric.quadric().flip_normals) middle_ += pi, reach_ = pi - reach_;
    }
}

Vec3 SeenQuadric::sample(Vec2 u) const {
    if (way_ == Way::area) return quadric_.own_uniform(u);
    if (way_ == Way::arc) {
        const float angle = middle_ + (2 * u.x - 1) * reach_;
        return {std::cos(angle), std::sin(angle), u.y};
    }
    const Vec3 to_center = -own_from_;
    const Vec3 ray = Frame::around(normalize(to_center)).to_world(cone(u, drop_));
    // Where the ray meets the sphere; at its rim where rounding lets it pass by.
    const Vec3 aside = ray * dot(to_center, ray) - to_center;
    return normalize(aside - ray * std::sqrt(std::max(0.0f, 1 - length_squared(aside))));
}

float SeenQuadric::pdf(Vec3 direction, Vec3 own) const {
    if (way_ == Way::cone) {  // a small cone of directions is so much wider in the quadric's own space
        const double size = length(quadric_.direction_to_own(direction));
        return float(1 / (2 * double{pi} * drop_ * quadric_.volume() * size * size * size));
    }
    const float own_area = way_ == Way::arc ? 2 * reach_ : quadric_.own_area();
    const float cosine = std::max(1e-6f, std::fabs(dot(quadric_.normal(own), direction)));
    const float distance2 = length_squared(quadric_.position(own) - from_);
    const float area = own_area * quadric_.stretch(own);
    return area > 0 ? distance2 / (area * cosine) : 0;
}

}  // namespace lightnet
