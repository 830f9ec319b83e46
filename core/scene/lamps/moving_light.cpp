#include "core/scene/lamps/moving_light.hpp"

#include <algorithm>
#include <variant>

namespace lightnet {
namespace {

Vec3 position_of(const BareLight& light) {
    const auto* spot = std::get_if<SpotLight>(&light);
    return spot ? spot->position : std::get<PointLight>(light).position;
}

NearLight ready(const BareLight& light) {
    const auto* spot = std::get_if<SpotLight>(&light);
    return spot ? near_light_of(*spot) : near_light_of(std::get<PointLight>(light));
}

PointLight between(const StepPlace& place, const PointLight& a, const PointLight& b) {
    return {place.between(a.position, b.position), place.between(a.intensity, b.intensity), a.label, {}};
}

SpotLight between(const StepPlace& place, const SpotLight& a, const SpotLight& b) {
    SpotLight spot = a;
    spot.position = place.between(a.position, b.position);
    const Vec3 axis = place.between(a.axis, b.axis);
    if (length_squared(axis) > 0) spot.axis = normalize(axis);
    spot.intensity = place.between(a.intensity, b.intensity);
    spot.inner = place.between(a.inner, b.inner);
    spot.outer = place.between(a.outer, b.outer);
    return spot;
}

}  // namespace

bool can_move(const BareLight& light) { return !std::holds_alternative<DirectionalLight>(light); }

MovingLight::MovingLight(const BareLight& first, std::span<const BareLight> later) : said_{first} {
    said_.insert(said_.end(), later.begin(), later.end());
    for (const BareLight& light : said_) ready_.push_back(ready(light));
}

template <class Use>
auto MovingLight::at(ShutterTime time, const Use& use) const {
    const StepPlace place(said_.size(), time);
    const BareLight &before = said_[place.step], &after = said_[place.step + 1];
    if (const auto* point = std::get_if<PointLight>(&ready_[place.step]))
        return use(between(place, *point, std::get<PointLight>(after)), Vec3{});
    if (const auto* spot = std::get_if<SpotLight>(&ready_[place.step]))
        return use(between(place, *spot, std::get<SpotLight>(after)), Vec3{});
    const std::size_t nearer = place.step + (place.part < 0.5f ? 0 : 1);
    const Vec3 away = place.between(position_of(before), position_of(after)) - position_of(said_[nearer]);
    return std::visit([&](const auto& light) { return use(light, away); }, ready_[nearer]);
}

std::optional<LightSample> MovingLight::from(Vec3 from, ShutterTime time) const {
    return at(time, [&](const auto& light, Vec3 away) {
        auto sample = light_from(light, from - away);
        if (sample) sample->position += away;
        return sample;
    });
}

Emission MovingLight::emission(Vec2 u, ShutterTime time) const {
    return at(time, [&](const auto& light, Vec3 away) {
        Emission emission = emission_of(light, u);
        emission.origin += away;
        return emission;
    });
}

LightBounds MovingLight::bounds() const {
    const auto of_step = [](const NearLight& light) {
        return std::visit([](const auto& one) { return bounds_of(one); }, light);
    };
    LightBounds all = of_step(ready_.front());
    for (const NearLight& light : ready_) all = around_both(all, of_step(light));
    return all;
}

Rgb MovingLight::power() const {
    Rgb most;
    for (const NearLight& light : ready_) {
        const Rgb step = std::visit([](const auto& one) { return power_of(one); }, light);
        if (luminance(step) > luminance(most)) most = step;
    }
    return most;
}

}  // namespace lightnet
