// Area lamps that are spheres or quadrics.
#include "core/base/math/box.hpp"
#include "core/base/math/octahedral.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/ball_lamp.hpp"
#include "core/scene/lamps/lamp_kinds.hpp"
#include "core/scene/lamps/quadric_lamp.hpp"

#include <cmath>

namespace lightnet {

namespace {

PointOnLamp on_sphere(const Sphere& ball, Vec3 outwards) {
    const Vec2 name = to_octahedral(outwards);
    return {on_ball(ball.center, ball.radius, outwards), ball.flip_normals ? -outwards : outwards, 0, name.x, name.y};
}

PointOnLamp on_quadric(const PlacedQuadric& quadric, Vec3 own) {
    const Vec2 name = quadric.name_of(own);
    return {quadric.position(own), quadric.normal(own), 0, name.x, name.y};
}

BallLamp ball_lamp(const AreaLamp& one, const Sphere& ball) {
    const LampSource& source = one.source;
    return {ball.center, ball.radius, one.area, source.radiance, ball.flip_normals, source.two_sided, source.group};
}

}  // namespace

LampBall ball_around(const Sphere* ball) { return {ball->center, ball->radius}; }
LampBall ball_around(const PlacedQuadric& quadric) {
    const Box box = quadric.bounds();
    return {box.center(), length(box.size()) / 2};
}

float area_of(const Sphere* ball) { return 4 * pi * ball->radius * ball->radius; }
float area_of(const PlacedQuadric& quadric) { return quadric.area(); }

LampStart start_on(const AreaLamp& lamp, const Sphere* ball, Vec2 u) {
    return {on_sphere(*ball, sphere(u)), lamp.area};
}

LampStart start_on(const AreaLamp&, const PlacedQuadric& quadric, Vec2 u) {
    const Vec3 own = quadric.own_uniform(u);
    return {on_quadric(quadric, own), quadric.own_area() * quadric.stretch(own)};
}

EvenLamp even_on(const AreaLamp& one, const Sphere* ball) {
    return one.source.uniform ? EvenLamp(ball_lamp(one, *ball)) : EvenLamp();
}

EvenLamp even_on(const AreaLamp&, const PlacedQuadric&) { return {}; }

std::optional<LightSample> sample_on(const LampLook& look, const AreaLamp& lamp, const Sphere* on) {
    const LampSource& source = lamp.source;
    const WayToBall way = way_to_ball(ball_lamp(lamp, *on), look.from, look.u);
    if (!way.found) return {};
    Rgb radiance = source.radiance;
    if (!source.uniform) {
        const PointOnLamp point = on_sphere(*on, way.outwards);
        if (!look.radiance.is_there(source, point)) return {};
        radiance = look.radiance.at(source, point);
    }
    return LightSample{way.position, way.direction, radiance, way.pdf, source.unseen, false, source.group};
}

std::optional<LightSample> sample_on(const LampLook& look, const AreaLamp& lamp, const PlacedQuadric& quadric) {
    const LampSource& source = lamp.source;
    const SeenQuadric seen(quadric, look.from, source.two_sided);
    const Vec3 own = seen.sample(look.u);
    const PointOnLamp point = on_quadric(quadric, own);
    const Vec3 way = point.position - look.from;
    const float way2 = length_squared(way);
    if (!(way2 > 0)) return {};
    const Vec3 direction = way / std::sqrt(way2);
    const float pdf = seen.pdf(direction, own);
    const bool dark =
        !(source.two_sided || dot(point.normal, -direction) > 0) || !look.radiance.is_there(source, point);
    if (dark || !(pdf > 0) || !std::isfinite(pdf)) return {};
    const float offset = offset_at(point.position, point.normal, quadric.own_offset(own, point.normal));
    const Vec3 end = off_surface(point.position, point.normal, offset, -direction);
    return LightSample{end, direction, look.radiance.at(source, point), pdf, source.unseen, false, source.group};
}

LightBounds bounds_of(const AreaLamp& one, const Sphere* ball, float radiance) {
    const Vec3 r{ball->radius, ball->radius, ball->radius};
    return {ball->center - r, ball->center + r, {0, 0, 1}, -1, 0, radiance * one.area / 4, false};
}

LightBounds bounds_of(const AreaLamp& one, const PlacedQuadric& quadric, float radiance) {
    const Box box = quadric.bounds();
    if (quadric.quadric().round == Quadric::Round::disk)
        return {box.low, box.high, quadric.normal({}), 1, 0, radiance * one.area, one.source.two_sided};
    return {box.low, box.high, {0, 0, 1}, -1, 0, radiance * one.area / 4, false};
}

float density(const Sphere* ball, const LampFound& found) {
    const SeenBall seen(ball->center, ball->radius, found.from);
    return seen.pdf(found.on.normal, found.direction, found.way2(), found.area);
}
float density(const PlacedQuadric& quadric, const LampFound& found) {
    const SeenQuadric seen(quadric, found.from, found.two_sided);
    return seen.pdf(found.direction, quadric.own_point({found.on.u, found.on.v}));
}

}  // namespace lightnet
