// A light without extent that moves while the shutter is open.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/math/shutter.hpp"
#include "core/scene/lamps/bare_lights.hpp"

namespace lightnet {

/// A point or spot light at evenly spaced steps; between two of them it goes evenly, but for pictures that it throws,
/// which stay turned as at the nearer step. Immutable; any thread may ask.
class MovingLight {
public:
    MovingLight(const BareLight& first, std::span<const BareLight> later);

    /// Each at its own time, chosen for certain: see light_from() and emission_of().
    std::optional<LightSample> from(Vec3 at, ShutterTime time) const;
    Emission emission(Vec2 u, ShutterTime time) const;
    /// Around all of its way.
    LightBounds bounds() const;
    /// All that it emits, W, where that is most.
    Rgb power() const;

private:
    /// use(light as it is then, how far it stands from where it is then).
    template <class Use>
    auto at(ShutterTime time, const Use& use) const;

    std::vector<BareLight> said_;
    std::vector<NearLight> ready_;
};

/// A directional light is none: where it moves, it stands as at first.
bool can_move(const BareLight& light);

}  // namespace lightnet
