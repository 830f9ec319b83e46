// Lights at a place of the scene, made ready: what every one of them must be able to say.
#pragma once

#include <cmath>
#include <concepts>
#include <optional>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/lamp_label.hpp"
#include "core/scene/bare_lights/light_bounds.hpp"
#include "core/scene/bare_lights/light_sample.hpp"

namespace lightnet {

/// What light from a place is found by.
///   from(): light that arrives somewhere, this light chosen for certain. None: it does not shine that way
///   bounds(): for the light tree
///   power(): all that it emits, W
///   emission(): light leaving it, by importance or nearly so; flux as if it were the only light
template <class N>
concept IsNearLight = requires(const N& light, Vec3 at, Vec2 u) {
    { light.label } -> std::same_as<const LampLabel&>;
    { light.from(at) } -> std::same_as<std::optional<LightSample>>;
    { light.bounds() } -> std::same_as<LightBounds>;
    { light.power() } -> std::convertible_to<Rgb>;
    { light.emission(u) } -> std::same_as<Emission>;
};

/// Light that a point sends to another one, by its intensity in that direction, W·sr⁻¹.
inline std::optional<LightSample> from_point(Vec3 position, Rgb intensity, Vec3 at) {
    const Vec3 way = position - at;
    const float distance2 = length_squared(way);
    if (!(distance2 > 0) || is_black(intensity)) return {};
    return LightSample{position, way / std::sqrt(distance2), intensity / distance2, 1, true, false};
}

}  // namespace lightnet
