// Points that shine by a pattern.
#pragma once

#include <optional>

#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/environment.hpp"
#include "core/scene/bare_lights/near_light.hpp"

namespace lightnet {

/// A point light that sends another intensity into each direction: the radiance of its pattern there. Immutable; any
/// thread may ask.
struct PatternedLight {
    Vec3 position;
    Environment pattern;
    LampLabel label{};

    std::optional<LightSample> from(Vec3 at) const;
    LightBounds bounds() const;
    Rgb power() const { return pattern.total(); }
    Emission emission(Vec2 u) const;
};

}  // namespace lightnet
