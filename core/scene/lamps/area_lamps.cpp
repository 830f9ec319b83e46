#include "core/scene/lamps/area_lamps.hpp"

#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr std::size_t most_known = 4096;  // more wouldn't stay in the cache

}  // namespace

AreaLamps::AreaLamps(const SceneData& data, const Shading& shading, GroupSet groups, bool apart)
    : data_(data), apart_(apart), sources_(data, shading, groups, apart), radiance_(data, shading) {
    for (std::size_t i = 0; size() <= most_known && i < size(); ++i) known_.push_back(even(i));
}

// Of 16 points. Never nothing: what lies between them may shine.
Rgb AreaLamps::mean_of_texture(const AreaLamp& lamp) const {
    const std::uint32_t shape = lamp.source.shape;
    if (!radiance_.has_texture(lamp.source) || !(lamp.area > 0)) return {1, 1, 1};
    Rgb sum{0.16f, 0.16f, 0.16f};
    for (int i = 0; i < 16; ++i) {
        const Vec2 u{(float(i % 4) + 0.5f) / 4, (float(i / 4) + 0.5f) / 4};
        const PointOnLamp point =
            sources_.on_shape(lamp, [&](const auto& placed) { return start_on(lamp, placed, u).point; });
        sum += radiance_.texture_at(shape, point.primitive, point.u, point.v);
    }
    return sum / 16.16f;
}

Rgb AreaLamps::radiance(const SurfacePoint& point, Vec3 direction) const {
    return shines(point.geometry) ? radiance_.towards(point, direction) : Rgb{};
}

std::optional<LightSample> AreaLamps::sample(std::size_t index, const LitPoint& from, Vec2 u) const {
    const AreaLamp one = sources_.lamp(index, from.time);
    const LampLook look{radiance_, from.position, u};
    return sources_.on_shape(one, [&](const auto& placed) { return sample_on(look, one, placed); });
}

EvenLamp AreaLamps::even(std::size_t index) const {
    const AreaLamp one = sources_.lamp(index, 0);
    if (sources_.moves(one)) return {};
    return sources_.on_shape(one, [&](const auto& placed) { return even_on(one, placed); });
}

float AreaLamps::pdf(std::size_t index, Vec3 from, Vec3 direction, const SurfacePoint& on) const {
    const AreaLamp one = sources_.lamp(index, on.time);
    const LampFound found{from, direction, on, one.area, one.source.two_sided};
    return sources_.on_shape(one, [&](const auto& placed) { return density(placed, found); });
}

LightBounds AreaLamps::bounds(std::size_t index) const {
    std::optional<LightBounds> all;
    sources_.at_each_step(index, [&](const AreaLamp& one) {
        const float radiance = luminance(one.source.radiance * mean_of_texture(one));
        const LightBounds step =
            sources_.on_shape(one, [&](const auto& placed) { return bounds_of(one, placed, radiance); });
        all = all ? around_both(*all, step) : step;
    });
    return *all;
}

Rgb AreaLamps::power(std::size_t index) const {
    Rgb most;
    sources_.at_each_step(index, [&](const AreaLamp& one) {
        const Rgb step = one.source.radiance * mean_of_texture(one) * (pi * one.area * (one.source.two_sided ? 2 : 1));
        if (!(luminance(step) < luminance(most))) most = step;
    });
    return most;
}

std::optional<Emission> AreaLamps::emit(std::size_t index, Vec2 position_sample, Vec2 direction_sample,
                                        ShutterTime time) const {
    const AreaLamp one = sources_.lamp(index, time);
    const LampSource& source = one.source;
    if (!(one.area > 0)) return {};
    float sides = 1;
    auto [start, area] =
        sources_.on_shape(one, [&](const auto& placed) { return start_on(one, placed, position_sample); });
    if (source.two_sided) {
        sides = 2;
        const bool back = direction_sample.x >= 0.5f;
        direction_sample.x = std::min(2 * (direction_sample.x - (back ? 0.5f : 0)), 0x1.fffffep-1f);
        if (back) start.normal = -start.normal;
    }
    if (!radiance_.is_there(source, start)) return {};
    const SurfacePoint point = radiance_.shading().point(source.shape, start.primitive, start.u, start.v, time);
    const Vec3 direction = Frame::around(start.normal).to_world(cosine_hemisphere(direction_sample));
    return Emission{point.origin_towards(direction), direction, radiance_.at(source, start) * (pi * area * sides),
                    source.group};
}

std::size_t AreaLamps::memory() const { return sources_.memory() + known_.size() * sizeof(EvenLamp); }

}  // namespace lightnet
