// Area lamps that are curves.
#include "core/base/math/box.hpp"
#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/area_lamps.hpp"

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

void AreaLamps::add(std::uint32_t shape, const Curves* curves) {
    const Box box = box_of(*curves);
    balls_.add(box.center(), length(box.size()) / 2);
    add_source(shape, 1, 0);
}

float AreaLamps::area(const Source&, const Curves* curves) const { return float(curves->area()); }

// Each segment as often as any other.
AreaLamps::Start AreaLamps::start(const Lamp&, const Curves* curves, Vec2 u) const {
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

AreaLamps::EvenLamp AreaLamps::even(const Lamp&, const Curves*) const { return {}; }

std::optional<LightSample> AreaLamps::sample(const Lamp& lamp, const Curves* curves, Vec3 from, Vec2 u) const {
    const Source& source = lamp.source;
    const auto [point, area] = start(lamp, curves, u);
    const Vec3 way = point.position - from;
    const float way2 = length_squared(way);
    if (!(way2 > 0)) return {};
    const Vec3 direction = way / std::sqrt(way2);
    const float cosine = -dot(point.normal, direction);  // of the outside, which alone is seen
    if (!(cosine > 1e-6f) || !is_there(source, point)) return {};
    const float pdf = way2 / (area * cosine);
    if (!(pdf > 0) || !std::isfinite(pdf)) return {};
    const float offset = shading_.point(source.shape, point.primitive, point.u, point.v).offset;
    const Vec3 end = off_surface(point.position, point.normal, offset, -direction);
    return LightSample{end, direction, radiance_at(source, point), pdf, source.unseen, false, source.group};
}

LightBounds AreaLamps::bounds(const Lamp& one, const Curves* curves, float radiance) const {
    const Box box = box_of(*curves);
    return {box.low, box.high, {0, 0, 1}, -1, 0, radiance * one.area / 4, false};
}

}  // namespace lightnet
