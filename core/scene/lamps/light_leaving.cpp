// Light that leaves lights, for those who follow it from there.
#include "core/base/math/frame.hpp"
#include "core/base/math/prefix_cdf.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/lights.hpp"

#include <algorithm>
#include <variant>

namespace lightnet {

// In the order in which emit() chooses them.
Rgb Lights::power(std::size_t light) const {
    if (light < lamps_.size()) return lamps_.power(light);
    light -= lamps_.size();
    if (light < near_.size()) return std::visit([](const auto& l) { return Rgb(l.power()); }, near_[light]);
    light -= near_.size();
    const float disk = pi * around_.radius * around_.radius;
    if (light < far_.size()) return far_.total(light) * disk;
    const auto& sky = *environments_[light - far_.size()];
    const auto& portal = sky.portal();
    return sky.total() * (portal ? length(cross(portal->side, portal->other)) : disk);
}

Rgb Lights::power() const {
    Rgb sum;
    for (std::size_t i = 0; i < count(); ++i) sum += power(i);
    return sum;
}

std::optional<Emission> Lights::emit(float choice, Vec2 position_sample, Vec2 direction_sample,
                                     ShutterTime time) const {
    if (power_ends_.empty()) return {};
    std::size_t light = pick(power_ends_, choice);
    const float chance = share_of(power_ends_, light);
    const auto weighted = [&](Emission one, std::uint32_t group) {
        one.flux *= 1 / chance;
        one.group = group;
        return one;
    };
    if (light < lamps_.size()) {
        const auto one = lamps_.emit(light, position_sample, direction_sample, time);
        return one ? std::optional(weighted(*one, one->group)) : std::nullopt;
    }
    light -= lamps_.size();
    if (light < near_.size())
        return std::visit(
            [&](const auto& l) { return weighted(emission_of(l, direction_sample, time), group(l.label)); },
            near_[light]);
    light -= near_.size();
    if (light < far_.size()) {
        const Vec3 along = far_.shines_along(light, direction_sample);
        return weighted(through_ball(along, far_.total(light), position_sample), far_.group(light));
    }
    const auto& sky = *environments_[light - far_.size()];
    return weighted(from_sky(sky, position_sample, direction_sample), environment_group_);
}

Emission Lights::from_sky(const Environment& environment, Vec2 position_sample, Vec2 direction_sample) const {
    const auto [towards, radiance, density] = environment.sample_all(direction_sample);
    const Rgb irradiance = density > 0 ? radiance / density : Rgb{};
    const auto& portal = environment.portal();
    return portal ? through_portal(*portal, -towards, irradiance, position_sample)
                  : through_ball(-towards, irradiance, position_sample);
}

// What it meets before it comes through the portal is dark.
Emission Lights::through_portal(const Portal& portal, Vec3 direction, Rgb irradiance, Vec2 position_sample) const {
    const Vec3 out = cross(portal.side, portal.other);
    const Vec3 at = portal.at(position_sample);
    const float area = std::max(0.0f, -dot(direction, out));  // across the direction
    const float way = length(at - around_.center) + around_.radius;
    return {at - direction * way, direction, irradiance * area, 0, way};
}

// From a disk across the direction, before the ball.
Emission Lights::through_ball(Vec3 direction, Rgb irradiance, Vec2 position_sample) const {
    const Frame frame = Frame::around(direction);
    const Vec2 at = disk(position_sample);
    return {around_.center + (frame.x * at.x + frame.y * at.y - direction) * around_.radius, direction,
            irradiance * (pi * around_.radius * around_.radius)};
}

}  // namespace lightnet
