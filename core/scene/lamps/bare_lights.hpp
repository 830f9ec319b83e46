// Lights without extent: what each sends where.
#pragma once

#include <optional>
#include <variant>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/lamps/environment.hpp"
#include "core/scene/lamps/light_tree.hpp"
#include "core/scene/lamps/slide_light.hpp"
#include "core/scene/surfaces/light_sample.hpp"

namespace lightnet {

/// A point light that sends another intensity into each direction: the radiance of its pattern there.
struct PatternedLight {
    Vec3 position;
    Environment pattern;
    LampLabel label{};
};
/// A light at a point of the scene, made ready.
using NearLight = std::variant<PointLight, SpotLight, PatternedLight, SlideLight>;
NearLight near_light_of(const PointLight& light);
NearLight near_light_of(const SpotLight& light);

/// Share of its full intensity that a spot light sends at an angle from its axis, given by the cosine.
float spot_falloff(const SpotLight& light, float cosine);

/// Light from a point or spot light, chosen for certain. None: it does not shine that way.
std::optional<LightSample> light_from(const PointLight& light, Vec3 from);
std::optional<LightSample> light_from(const SpotLight& light, Vec3 from);
std::optional<LightSample> light_from(const PatternedLight& light, Vec3 from);
std::optional<LightSample> light_from(const SlideLight& light, Vec3 from);

/// For the light tree.
LightBounds bounds_of(const PointLight& light);
LightBounds bounds_of(const SpotLight& light);
LightBounds bounds_of(const PatternedLight& light);
LightBounds bounds_of(const SlideLight& light);

/// All that it emits, W.
Rgb power_of(const PointLight& light);
Rgb power_of(const SpotLight& light);
Rgb power_of(const PatternedLight& light);
Rgb power_of(const SlideLight& light);

/// Light leaving it, by importance or nearly so; flux as if it were the only light.
Emission emission_of(const PointLight& light, Vec2 u);
Emission emission_of(const SpotLight& light, Vec2 u);
Emission emission_of(const PatternedLight& light, Vec2 u);
Emission emission_of(const SlideLight& light, Vec2 u);

}  // namespace lightnet
