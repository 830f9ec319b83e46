#include "core/scene/bare_lights/point_light.hpp"

#include "core/base/math/sampling.hpp"
#include "core/scene/bare_lights/patterned_light.hpp"

namespace lightnet {

std::variant<PointLight, PatternedLight> PointLight::ready() const {
    if (!pattern) return *this;
    EnvironmentData brightened = *pattern;
    brightened.radiance *= intensity;
    return PatternedLight{position, Environment(brightened), label};
}

LightBounds PointLight::bounds() const { return {position, position, {0, 0, 1}, -1, 0, luminance(intensity), false}; }

Rgb PointLight::power() const { return intensity * (4 * pi); }

Emission PointLight::emission(Vec2 u) const { return {position, sphere(u), power()}; }

std::optional<LightSample> PatternedLight::from(Vec3 at) const {
    const Vec3 way = at - position;
    if (!(length_squared(way) > 0)) return {};
    return from_point(position, pattern.radiance(normalize(way)), at);
}

// By the mean of its intensity: what it sends into the brightest direction may be a thousand times that.
LightBounds PatternedLight::bounds() const {
    return {position, position, {0, 0, 1}, -1, 0, luminance(pattern.total()) / (4 * pi), false};
}

Emission PatternedLight::emission(Vec2 u) const {
    const SkyRadiance sent = pattern.sample_all(u);
    return {position, sent.direction, sent.pdf > 0 ? sent.radiance / sent.pdf : Rgb{}};
}

}  // namespace lightnet
