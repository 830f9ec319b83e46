#include "core/scene/lamps/bare_lights.hpp"

#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

std::optional<LightSample> from_point(Vec3 position, Rgb intensity, Vec3 from) {
    const Vec3 way = position - from;
    const float distance2 = length_squared(way);
    if (!(distance2 > 0) || is_black(intensity)) return {};
    return LightSample{position, way / std::sqrt(distance2), intensity / distance2, 1, true, false};
}

float outer_cosine(const SpotLight& light) { return std::cos(std::max(light.inner, light.outer)); }

}  // namespace

NearLight near_light_of(const PointLight& light) {
    if (!light.pattern) return light;
    EnvironmentData pattern = *light.pattern;
    pattern.radiance *= light.intensity;
    return PatternedLight{light.position, Environment(pattern), light.label};
}

NearLight near_light_of(const SpotLight& light) {
    if (light.slide) return SlideLight(light);
    return light;
}

float spot_falloff(const SpotLight& light, float cosine) {
    const float inner = std::cos(light.inner), outer = outer_cosine(light);
    if (cosine >= inner) return 1;
    if (!(cosine > outer)) return 0;
    const float t = (cosine - outer) / (inner - outer);
    switch (light.falloff) {
        case SpotLight::Falloff::smoothstep:
            return t * t * (3 - 2 * t);
        case SpotLight::Falloff::squared_linear:
            return t * t;
        case SpotLight::Falloff::fourth_power:
            return (t * t) * (t * t);
        case SpotLight::Falloff::linear:
            break;
    }
    return std::clamp((light.outer - std::acos(std::clamp(cosine, -1.0f, 1.0f))) / (light.outer - light.inner), 0.0f,
                      1.0f);
}

std::optional<LightSample> light_from(const PointLight& light, Vec3 from) {
    return from_point(light.position, light.intensity, from);
}

std::optional<LightSample> light_from(const SpotLight& light, Vec3 from) {
    const Vec3 way = from - light.position;
    return from_point(light.position, light.intensity * spot_falloff(light, dot(way, light.axis) / length(way)), from);
}

std::optional<LightSample> light_from(const PatternedLight& light, Vec3 from) {
    const Vec3 way = from - light.position;
    if (!(length_squared(way) > 0)) return {};
    return from_point(light.position, light.pattern.radiance(normalize(way)), from);
}

std::optional<LightSample> light_from(const SlideLight& light, Vec3 from) {
    const Vec3 way = from - light.position;
    if (!(length_squared(way) > 0)) return {};
    return from_point(light.position, light.towards(normalize(way)), from);
}

LightBounds bounds_of(const SlideLight& light) { return light.bounds(); }

Rgb power_of(const SlideLight& light) { return light.power(); }

Emission emission_of(const SlideLight& light, Vec2 u) { return light.emission(u); }

// By the mean of its intensity: what it sends into the brightest direction may be a thousand times that.
LightBounds bounds_of(const PatternedLight& light) {
    return {light.position, light.position, {0, 0, 1}, -1, 0, luminance(light.pattern.total()) / (4 * pi), false};
}

Rgb power_of(const PatternedLight& light) { return light.pattern.total(); }

Emission emission_of(const PatternedLight& light, Vec2 u) {
    const SkyRadiance sent = light.pattern.sample_all(u);
    return {light.position, sent.direction, sent.pdf > 0 ? sent.radiance / sent.pdf : Rgb{}};
}

LightBounds bounds_of(const PointLight& light) {
    return {light.position, light.position, {0, 0, 1}, -1, 0, luminance(light.intensity), false};
}

LightBounds bounds_of(const SpotLight& light) {
    // As if it were a part of a ball with normals within the inner angle, each of which reaches the outer one.
    const float reach = std::cos(std::min(pi / 2, std::max(0.0f, light.outer - light.inner) + 1e-3f));
    const bool wide = light.outer > pi / 2 + light.inner;
    return {light.position,
            light.position,
            light.axis,
            wide ? -1 : std::cos(light.inner),
            wide ? 0 : reach,
            luminance(light.intensity),
            false};
}

Rgb power_of(const PointLight& light) { return light.intensity * (4 * pi); }

Rgb power_of(const SpotLight& light) {
    const float i = light.inner, o = std::max(light.inner, light.outer), across = std::cos(i) - std::cos(o);
    switch (light.falloff) {
        case SpotLight::Falloff::smoothstep:
            return light.intensity * (2 * pi * (1 - std::cos(i) + across / 2));
        case SpotLight::Falloff::squared_linear:
            return light.intensity * (2 * pi * (1 - std::cos(i) + across / 3));
        case SpotLight::Falloff::fourth_power:
            return light.intensity * (2 * pi * (1 - std::cos(i) + across / 5));
        case SpotLight::Falloff::linear:
            break;
    }
    const float slope = o - i > 1e-3f ? (std::sin(o) - std::sin(i)) / (o - i) : std::cos((o + i) / 2);
    return light.intensity * (2 * pi * (1 - slope));
}

Emission emission_of(const PointLight& light, Vec2 u) { return {light.position, sphere(u), power_of(light)}; }

Emission emission_of(const SpotLight& light, Vec2 u) {
    const float opening = std::max(1e-9f, 1 - outer_cosine(light));
    const Vec3 local = cone(u, opening);
    return {light.position, Frame::around(light.axis).to_world(local),
            light.intensity * (spot_falloff(light, local.z) * 2 * pi * opening)};
}

}  // namespace lightnet
