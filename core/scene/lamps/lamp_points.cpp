#include "core/scene/lamps/lamp_points.hpp"

namespace lightnet {
namespace {

struct Way {
    Vec3 position, direction;
    float pdf;
    bool found;
};
[[gnu::always_inline]] inline Way way_to(const FlatLamp& lamp, Vec3 from, Vec2 u) {
    const Vec2 folded = triangle(u);
    const Vec3 position = lamp.facet.at({lamp.whole ? u.x : folded.x, lamp.whole ? u.y : folded.y});
    const auto [direction, pdf, found] =
        direction_to_lamp(from, position, lamp.facet.normal, lamp.area, lamp.two_sided);
    return {before_lamp(lamp.facet, position, direction), direction, pdf, found};
}
[[gnu::always_inline]] inline Way way_to(const BallLamp& lamp, Vec3 from, Vec2 u) {
    const WayToBall way = way_to_ball(lamp, from, u);
    return {way.position, way.direction, way.pdf, way.found};
}

}  // namespace

void FlatLampColumns::set(std::size_t i, const FlatLamp& lamp) {
    corner.set(i, lamp.facet.corner);
    first_edge.set(i, lamp.facet.first_edge);
    second_edge.set(i, lamp.facet.second_edge);
    normal.set(i, lamp.facet.normal);
    whole[i] = lamp.whole;
}

void BallLampColumns::set(std::size_t i, const BallLamp& lamp) {
    center.set(i, lamp.center);
    radius[i] = lamp.radius;
    inwards[i] = lamp.inwards;
}

template <class Forms>
void LampPoints<Forms>::add(const LampAsked& asked, const typename Forms::Lamp& lamp) {
    const std::size_t i = count_++;
    who_[i] = asked.who;
    from_.set(i, asked.from);
    u_.set(i, asked.u);
    chance_[i] = asked.chance;
    forms_.set(i, lamp);
    radiance_.set(i, {lamp.radiance.r, lamp.radiance.g, lamp.radiance.b});
    two_sided_[i] = lamp.two_sided;
    area_[i] = lamp.area;
    group_[i] = lamp.group;
}

template <class Forms>
struct LampPoints<Forms>::Finding {
    LampPoints& at;
    float share;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < at.count_; ++i) {
            auto lamp = at.forms_[i];
            lamp.area = at.area_[i];
            lamp.two_sided = at.two_sided_[i] != 0;
            const Way way = way_to(lamp, at.from_[i], at.u_[i]);
            at.position_.set(i, way.position);
            at.direction_.set(i, way.direction);
            at.pdf_[i] = way.pdf * at.chance_[i] * share;
            at.found_[i] = way.found;
        }
    }
};

template <class Forms>
void LampPoints<Forms>::find(float share, LightSamples& samples) {
    if (count_ == 0) return;
    Finding finding{*this, share};
    work_in_lanes(finding);
    write(samples);
}

template <class Forms>
void LampPoints<Forms>::write(LightSamples& samples) const {
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

template class LampPoints<FlatLampColumns>;
template class LampPoints<BallLampColumns>;

}  // namespace lightnet
