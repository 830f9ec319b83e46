#include "core/scene/lamps/skies.hpp"

#include "core/base/math/frame.hpp"
#include "core/base/math/prefix_cdf.hpp"
#include "core/base/math/sampling.hpp"

#include <algorithm>
#include <array>

namespace lightnet {

float within(float choice, float start, float share) {
    return std::clamp((choice - start) / share, 0.0f, 0x1.fffffep-1f);
}

Skies::Skies(const SceneData& data, std::uint32_t group) : group_(group) {
    std::vector<double> light_of_maps;
    for (const auto& each : data.environments) {
        const Environment& environment = environments_.emplace_back(each);
        shine_ |= !is_black(environment.total());
        has_portals_ |= environment.portal().has_value();
        const bool everywhere = !environment.has_map() && !environment.portal();
        if (everywhere) constant_ += each.radiance;
        if (everywhere || is_black(environment.total())) continue;
        maps_.push_back(std::uint32_t(environments_.size() - 1));
        light_of_maps.push_back(luminance(environment.total()));
    }
    prefix_cdf(light_of_maps, map_ends_);
}

LightSample Skies::sampled_as(const SkyRadiance& seen) const {
    return {{}, seen.direction, constant_ + seen.radiance, seen.pdf, false, true, group_};
}

std::optional<LightSample> Skies::sample(Vec3 from, float choice, Vec2 u) const {
    if (has_portals_) return through_portals(from, choice, u);
    const std::size_t map_index = maps_.size() > 1 ? pick(map_ends_, choice) : 0;
    const SkyRadiance seen = environments_[maps_[map_index]].sample(u);
    if (maps_.size() == 1) return sampled_as(seen);
    float density = share_of(map_ends_, map_index) * seen.pdf;
    Rgb radiance = constant_ + seen.radiance;
    for (std::size_t i = 0; i < maps_.size(); ++i) {
        if (i == map_index) continue;
        const SkyRadiance other = environments_[maps_[i]].look(seen.direction);
        density += share_of(map_ends_, i) * other.pdf;
        radiance += other.radiance;
    }
    return LightSample{{}, seen.direction, radiance, density, false, true, group_};
}

// Half of the directions to a map behind a portal go by the map, the others to the portal.
// DECISIONS: portals-are-all-there-is
std::optional<LightSample> Skies::through_portals(Vec3 from, float choice, Vec2 u) const {
    const std::size_t map_index = maps_.size() > 1 ? pick(map_ends_, choice) : 0;
    const Environment& sky = environments_[maps_[map_index]];
    const auto& portal = sky.portal();
    // not by `choice`, which is none where there is nothing else to choose from
    const bool half = portal && sky.has_map(), first_half = u.x < 0.5f, to_portal = portal && (!half || first_half);
    if (half) u.x = within(u.x, first_half ? 0 : 0.5f, 0.5f);
    const Vec3 direction = to_portal ? normalize(portal->at(u) - from) : sky.sample(u).direction;
    const Ray ray{from, direction};
    const float density = pdf(ray);
    const Rgb radiance = this->radiance(ray);
    if (!(density > 0) || is_black(radiance)) return {};
    return LightSample{{}, direction, radiance, density, false, true, group_};
}

void Skies::sample(std::span<const Vec2> u, std::span<SkyRadiance> seen) const {
    environments_[maps_[0]].sample(u, seen);
}

float Skies::density_of(std::size_t map, const Ray& ray) const {
    const Environment& sky = environments_[maps_[map]];
    if (!sky.portal()) return sky.pdf(ray.direction);
    const float through = sky.portal()->density(ray.origin, ray.direction);
    return sky.has_map() ? 0.5f * (through + sky.pdf(ray.direction)) : through;
}

float Skies::pdf(const Ray& ray) const {
    float density = 0;
    for (std::size_t i = 0; i < maps_.size(); ++i) density += share_of(map_ends_, i) * density_of(i, ray);
    return density;
}

Rgb Skies::radiance(const Ray& ray) const {
    Rgb sum = constant_;
    for (const auto map : maps_)
        if (environments_[map].shows(ray)) sum += environments_[map].radiance(ray.direction);
    return sum;
}

void Skies::look(std::span<const Ray> rays, std::span<SkyRadiance> seen) const {
    if (one_map()) {
        std::array<Vec3, lanes> directions;
        for (std::size_t i = 0; i < rays.size(); ++i) directions[i] = rays[i].direction;
        environments_[maps_[0]].look(std::span(directions).first(rays.size()), seen);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            seen[i].radiance = constant_ + seen[i].radiance;
            seen[i].pdf = share_of(map_ends_, 0) * seen[i].pdf;
        }
        return;
    }
    for (std::size_t i = 0; i < rays.size(); ++i) seen[i] = {rays[i].direction, radiance(rays[i]), pdf(rays[i])};
}

Rgb Skies::power(std::size_t sky, const BallAround& around) const {
    const auto& environment = environments_[sky];
    const auto& portal = environment.portal();
    return environment.total() *
           (portal ? length(cross(portal->side, portal->other)) : pi * around.radius * around.radius);
}

namespace {

// What it meets before it comes through the portal is dark.
Emission through_portal(const BallAround& around, const Portal& portal, Vec3 direction, Rgb irradiance,
                        Vec2 position_sample) {
    const Vec3 out = cross(portal.side, portal.other);
    const Vec3 at = portal.at(position_sample);
    const float area = std::max(0.0f, -dot(direction, out));  // across the direction
    const float way = length(at - around.center) + around.radius;
    return {at - direction * way, direction, irradiance * area, 0, way};
}

}  // namespace

Emission through_ball(const BallAround& around, Vec3 direction, Rgb irradiance, Vec2 position_sample) {
    const Frame frame = Frame::around(direction);
    const Vec2 at = disk(position_sample);
    return {around.center + (frame.x * at.x + frame.y * at.y - direction) * around.radius, direction,
            irradiance * (pi * around.radius * around.radius)};
}

Emission Skies::emit(std::size_t sky, const BallAround& around, Vec2 position_sample, Vec2 direction_sample) const {
    const auto& environment = environments_[sky];
    const auto [towards, radiance, density] = environment.sample_all(direction_sample);
    const Rgb irradiance = density > 0 ? radiance / density : Rgb{};
    const auto& portal = environment.portal();
    return portal ? through_portal(around, *portal, -towards, irradiance, position_sample)
                  : through_ball(around, -towards, irradiance, position_sample);
}

std::size_t Skies::memory() const {
    std::size_t bytes = 0;
    for (const auto& environment : environments_) bytes += environment.memory();
    return bytes;
}

}  // namespace lightnet
