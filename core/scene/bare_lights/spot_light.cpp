#include "core/scene/bare_lights/spot_light.hpp"

#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bare_lights/slide_light.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

float outer_cosine(const SpotLight& light) { return std::cos(std::max(light.inner, light.outer)); }

}  // namespace

std::variant<SpotLight, SlideLight> SpotLight::ready() const {
    if (slide) return SlideLight(*this);
    return *this;
}

bool SpotLight::stands_as(const SpotLight& other) const {
    return position == other.position && axis == other.axis && intensity == other.intensity && inner == other.inner &&
           outer == other.outer;
}

SpotLight SpotLight::between(const StepPlace& place, const SpotLight& later) const {
    const Vec3 turned = place.between(axis, later.axis);
    return {place.between(position, later.position),   length_squared(turned) > 0 ? normalize(turned) : axis,
            place.between(intensity, later.intensity), place.between(inner, later.inner),
            place.between(outer, later.outer),         falloff};
}

float SpotLight::share_at(float cosine) const {
    const float all = std::cos(inner), none = outer_cosine(*this);
    if (cosine >= all) return 1;
    if (!(cosine > none)) return 0;
    const float t = (cosine - none) / (all - none);
    switch (falloff) {
        case Falloff::smoothstep:
            return t * t * (3 - 2 * t);
        case Falloff::squared_linear:
            return t * t;
        case Falloff::fourth_power:
            return (t * t) * (t * t);
        case Falloff::linear:
            break;
    }
    return std::clamp((outer - std::acos(std::clamp(cosine, -1.0f, 1.0f))) / (outer - inner), 0.0f, 1.0f);
}

std::optional<LightSample> SpotLight::from(Vec3 at) const {
    const Vec3 way = at - position;
    return from_point(position, intensity * share_at(dot(way, axis) / length(way)), at);
}

LightBounds SpotLight::bounds() const {
    // As if it were a part of a ball with normals within the inner angle, each of which reaches the outer one.
    const float reach = std::cos(std::min(pi / 2, std::max(0.0f, outer - inner) + 1e-3f));
    const bool wide = outer > pi / 2 + inner;
    return {position, position, axis, wide ? -1 : std::cos(inner), wide ? 0 : reach, luminance(intensity), false};
}

Rgb SpotLight::power() const {
    const float i = inner, o = std::max(inner, outer), across = std::cos(i) - std::cos(o);
    switch (falloff) {
        case Falloff::smoothstep:
            return intensity * (2 * pi * (1 - std::cos(i) + across / 2));
        case Falloff::squared_linear:
            return intensity * (2 * pi * (1 - std::cos(i) + across / 3));
        case Falloff::fourth_power:
            return intensity * (2 * pi * (1 - std::cos(i) + across / 5));
        case Falloff::linear:
            break;
    }
    const float slope = o - i > 1e-3f ? (std::sin(o) - std::sin(i)) / (o - i) : std::cos((o + i) / 2);
    return intensity * (2 * pi * (1 - slope));
}

Emission SpotLight::emission(Vec2 u) const {
    const float opening = std::max(1e-9f, 1 - outer_cosine(*this));
    const Vec3 local = cone(u, opening);
    return {position, Frame::around(axis).to_world(local), intensity * (share_at(local.z) * 2 * pi * opening)};
}

}  // namespace lightnet
