// Light that leaves lights, for those who follow it from there.
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
    if (light < far_.size()) return far_.total(light) * (pi * around_.radius * around_.radius);
    return skies_.power(light - far_.size(), around_);
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
        return weighted(through_ball(around_, along, far_.total(light), position_sample), far_.group(light));
    }
    return weighted(skies_.emit(light - far_.size(), around_, position_sample, direction_sample), environment_group_);
}

}  // namespace lightnet
