// Area lamps that are spheres or quadrics.
#include "core/base/math/box.hpp"
#include "core/base/math/octahedral.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/area_lamps.hpp"
#include "core/scene/lamps/ball_lamp.hpp"
#include "core/scene/lamps/quadric_lamp.hpp"

#include <cmath>

namespace lightnet {

void AreaLamps::add(std::uint32_t shape, const Sphere* ball) {
    balls_.add(ball->center, ball->radius);
    add_source(shape, 1, 0);
}

void AreaLamps::add(std::uint32_t shape, const PlacedQuadric& quadric) {
    const Box box = quadric.bounds();
    balls_.add(box.center(), length(box.size()) / 2);
    add_source(shape, 1, 0);
}

float AreaLamps::area(const Source&, const Sphere* ball) const { return 4 * pi * ball->radius * ball->radius; }
float AreaLamps::area(const Source&, const PlacedQuadric& quadric) const { return quadric.area(); }

AreaLamps::Start AreaLamps::start(const Lamp& lamp, const Sphere* ball, Vec2 u) const {
    return {on_sphere(*ball, sphere(u)), lamp.area};
}

AreaLamps::Start AreaLamps::start(const Lamp&, const PlacedQuadric& quadric, Vec2 u) const {
    const Vec3 own = quadric.own_uniform(u);
    return {on_quadric(quadric, own), quadric.own_area() * quadric.stretch(own)};
}

AreaLamps::PointOnLamp AreaLamps::on_sphere(const Sphere& ball, Vec3 outwards) {
    const Vec2 name = to_octahedral(outwards);
    return {on_ball(ball.center, ball.radius, outwards), ball.flip_normals ? -outwards : outwards, 0, name.x, name.y};
}

AreaLamps::PointOnLamp AreaLamps::on_quadric(const PlacedQuadric& quadric, Vec3 own) {
    const Vec2 name = quadric.name_of(own);
    return {quadric.position(own), quadric.normal(own), 0, name.x, name.y};
}

BallLamp AreaLamps::ball_lamp(const Lamp& one, const Sphere& ball) {
    const Source& source = one.source;
    return {ball.center, ball.radius, one.area, source.radiance, ball.flip_normals, source.two_sided, source.group};
}

AreaLamps::EvenLamp AreaLamps::even(const Lamp& one, const Sphere* ball) const {
    return one.source.uniform ? EvenLamp(ball_lamp(one, *ball)) : EvenLamp();
}

AreaLamps::EvenLamp AreaLamps::even(const Lamp&, const PlacedQuadric&) const { return {}; }

std::optional<LightSample> AreaLamps::sample(const Lamp& lamp, const Sphere* on, Vec3 from, Vec2 u) const {
    const Source& source = lamp.source;
    const WayToBall way = way_to_ball(ball_lamp(lamp, *on), from, u);
    if (!way.found) return {};
    Rgb radiance = source.radiance;
    if (!source.uniform) {
        const PointOnLamp point = on_sphere(*on, way.outwards);
        if (!is_there(source, point)) return {};
        radiance = radiance_at(source, point);
    }
    return LightSample{way.position, way.direction, radiance, way.pdf, source.unseen, false, source.group};
}

std::optional<LightSample> AreaLamps::sample(const Lamp& lamp, const PlacedQuadric& quadric, Vec3 from, Vec2 u) const {
    const Source& source = lamp.source;
    const SeenQuadric seen(quadric, from, source.two_sided);
    const Vec3 own = seen.sample(u);
    const PointOnLamp point = on_quadric(quadric, own);
    const Vec3 way = point.position - from;
    const float way2 = length_squared(way);
    if (!(way2 > 0)) return {};
    const Vec3 direction = way / std::sqrt(way2);
    const float pdf = seen.pdf(direction, own);
    const bool dark = !(source.two_sided || dot(point.normal, -direction) > 0) || !is_there(source, point);
    if (dark || !(pdf > 0) || !std::isfinite(pdf)) return {};
    const float offset = offset_at(point.position, point.normal, quadric.own_offset(own, point.normal));
    const Vec3 end = off_surface(point.position, point.normal, offset, -direction);
    return LightSample{end, direction, radiance_at(source, point), pdf, source.unseen, false, source.group};
}

LightBounds AreaLamps::bounds(const Lamp& one, const Sphere* ball, float radiance) const {
    const Vec3 r{ball->radius, ball->radius, ball->radius};
    return {ball->center - r, ball->center + r, {0, 0, 1}, -1, 0, radiance * one.area / 4, false};
}

LightBounds AreaLamps::bounds(const Lamp& one, const PlacedQuadric& quadric, float radiance) const {
    const Box box = quadric.bounds();
    if (quadric.quadric().round == Quadric::Round::disk)
        return {box.low, box.high, quadric.normal({}), 1, 0, radiance * one.area, one.source.two_sided};
    return {box.low, box.high, {0, 0, 1}, -1, 0, radiance * one.area / 4, false};
}

}  // namespace lightnet
