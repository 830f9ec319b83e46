// Area lamps that are curves.
#include "core/base/math/box.hpp"
#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/lamp_kinds.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

Box box_of(const Curves& curves) {
    Box box;
    curves.add_to(box, Matrix{});
    return box;
}

}  // namespace

LampBall ball_around(const Curves* curves) {
    const Box box = box_of(*curves);
    return {box.center(), length(box.size()) / 2};
}

float area_of(const Curves* curves) { return float(curves->area()); }

// Each segment as often as any other.
LampStart start_on(const AreaLamp&, const Curves* curves, Vec2 u) {
    const auto count = std::uint32_t(curves->pieces());
    const float chosen = u.x * float(count);
    const std::uint32_t segment = std::min(std::uint32_t(chosen), count - 1);
    const OnCurve middle = curves->at(segment, std::clamp(chosen - float(segment), 0.0f, 1.0f));
    // evenly in the angle, and then by its name
    const float speed = length(middle.slope);
    const Frame frame = Frame::around(speed > 0 ? middle.slope / speed : Vec3{0, 0, 1});
    const float turn = 2 * pi * u.y;
    const float name = across(middle, frame.x * std::cos(turn) + frame.y * std::sin(turn));
    const CurveSurface at = surface_of(middle, name);
    return {{at.position, at.normal, segment, chosen - float(segment), name}, float(count) * at.stretch};
}

EvenLamp even_on(const AreaLamp&, const Curves*) { return {}; }

std::optional<LightSample> sample_on(const LampLook& look, const AreaLamp& lamp, const Curves* curves) {
    const LampSource& source = lamp.source;
    const auto [point, area] = start_on(lamp, curves, look.u);
    const Vec3 way = point.position - look.from;
    const float way2 = length_squared(way);
    if (!(way2 > 0)) return {};
    const Vec3 direction = way / std::sqrt(way2);
    const float cosine = -dot(point.normal, direction);  // of the outside, which alone is seen
    if (!(cosine > 1e-6f) || !look.radiance.is_there(source, point)) return {};
    const float pdf = way2 / (area * cosine);
    if (!(pdf > 0) || !std::isfinite(pdf)) return {};
    const float offset = look.radiance.shading().point(source.shape, point.primitive, point.u, point.v).offset;
    const Vec3 end = off_surface(point.position, point.normal, offset, -direction);
    return LightSample{end, direction, look.radiance.at(source, point), pdf, source.unseen, false, source.group};
}

LightBounds bounds_of(const AreaLamp& one, const Curves* curves, float radiance) {
    const Box box = box_of(*curves);
    return {box.low, box.high, {0, 0, 1}, -1, 0, radiance * one.area / 4, false};
}

float density(const Curves* curves, const LampFound& found) {
    const OnCurve middle = curves->at(found.on.primitive, found.on.u);
    const float area = float(curves->pieces()) * surface_of(middle, found.on.v).stretch;
    const float cosine = std::max(1e-6f, std::fabs(dot(found.on.normal, found.direction)));
    return area > 0 ? found.way2() / (area * cosine) : 0;
}

}  // namespace lightnet
