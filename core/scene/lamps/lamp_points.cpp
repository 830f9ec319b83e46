#include "core/scene/lamps/lamp_points.hpp"

namespace lightnet {

void LampPoints::add(const LampAsked& asked, Rgb radiance, bool two_sided, float area, std::uint32_t group) {
    const std::size_t i = count_++;
    who_[i] = asked.who;
    from_.set(i, asked.from);
    u_.set(i, asked.u);
    chance_[i] = asked.chance;
    radiance_.set(i, {radiance.r, radiance.g, radiance.b});
    two_sided_[i] = two_sided;
    area_[i] = area;
    group_[i] = group;
}

void LampPoints::write(LightSamples& samples) const {
    for (std::size_t i = 0; i < count_; ++i) {
        const std::uint32_t to = who_[i];
        samples.position.set(to, position_[i]);
        samples.direction.set(to, direction_[i]);
        samples.radiance.set(to, radiance_[i]);
        samples.pdf[to] = pdf_[i];
        samples.found[to] = found_[i];
        samples.bare[to] = samples.from_infinity[to] = 0;
        samples.group[to] = group_[i];
    }
}

void FlatLampPoints::add(const LampAsked& asked, const FlatLamp& lamp) {
    const std::size_t i = count_;
    LampPoints::add(asked, lamp.radiance, lamp.two_sided, lamp.area, lamp.group);
    corner_.set(i, lamp.facet.corner);
    first_edge_.set(i, lamp.facet.first_edge);
    second_edge_.set(i, lamp.facet.second_edge);
    normal_.set(i, lamp.facet.normal);
    whole_[i] = lamp.whole;
}

struct FlatLampPoints::Finding {
    FlatLampPoints& at;
    float share;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < at.count_; ++i) {
            const Vec2 u = at.u_[i], folded = triangle(u);
            const bool whole = at.whole_[i] != 0;
            const Facet facet{at.corner_[i], at.first_edge_[i], at.second_edge_[i], at.normal_[i]};
            const Vec3 position = facet.at({whole ? u.x : folded.x, whole ? u.y : folded.y});
            const DirectionToLamp way =
                direction_to_lamp(at.from_[i], position, facet.normal, at.area_[i], at.two_sided_[i] != 0);
            at.position_.set(i, position);
            at.direction_.set(i, way.direction);
            at.pdf_[i] = way.pdf * at.chance_[i] * share;
            at.found_[i] = way.found;
        }
    }
};

void FlatLampPoints::find(float share, LightSamples& samples) {
    if (count_ == 0) return;
    Finding finding{*this, share};
    work_in_lanes(finding);
    write(samples);
}

void BallLampPoints::add(const LampAsked& asked, const BallLamp& lamp) {
    const std::size_t i = count_;
    LampPoints::add(asked, lamp.radiance, lamp.two_sided, lamp.area, lamp.group);
    center_.set(i, lamp.center);
    radius_[i] = lamp.radius;
    inwards_[i] = lamp.inwards;
}

struct BallLampPoints::Finding {
    BallLampPoints& at;
    float share;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < at.count_; ++i) {
            BallLamp ball;
            ball.center = at.center_[i];
            ball.radius = at.radius_[i];
            ball.area = at.area_[i];
            ball.inwards = at.inwards_[i] != 0;
            ball.two_sided = at.two_sided_[i] != 0;
            const WayToBall way = way_to_ball(ball, at.from_[i], at.u_[i]);
            at.position_.set(i, way.position);
            at.direction_.set(i, way.direction);
            at.pdf_[i] = way.pdf * at.chance_[i] * share;
            at.found_[i] = way.found;
        }
    }
};

void BallLampPoints::find(float share, LightSamples& samples) {
    if (count_ == 0) return;
    Finding finding{*this, share};
    work_in_lanes(finding);
    write(samples);
}

}  // namespace lightnet
