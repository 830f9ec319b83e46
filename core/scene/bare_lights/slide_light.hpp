// A point that throws a picture, as a slide projector does.
#pragma once

#include <optional>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/near_light.hpp"
#include "core/scene/bare_lights/spot_light.hpp"

namespace lightnet {

/// A spot light whose light passes a slide. Immutable; any thread may ask.
// DECISIONS: slides-of-spots
class SlideLight {
public:
    /// Of a spot that has one.
    explicit SlideLight(const SpotLight& spot);

    /// Radiant intensity towards `direction` (unit, from the light), W·sr⁻¹.
    Rgb towards(Vec3 direction) const;
    /// All that it emits, W.
    const Rgb& power() const { return power_; }
    /// See IsNearLight.
    std::optional<LightSample> from(Vec3 at) const;
    LightBounds bounds() const;
    /// Light leaving it, by how bright the slide is there; flux as if it were the only light.
    Emission emission(Vec2 u) const;

    Vec3 position;
    LampLabel label;

private:
    /// A place on the plane at distance 1 (x and y), in the slide's own axes.
    Rgb at(Vec2 plane) const;
    Vec2 plane_of(double column, double row) const;
    Vec3 local(Vec3 direction) const;
    void weigh();

    SpotLight spot_;
    Slide slide_;
    Vec3 x_, y_, z_;              // the slide's axes in world space
    std::vector<float> rows_;     // share of all light up to and with each row of pixels
    std::vector<float> columns_;  // by row: share of the row's light up to and with each
    Rgb power_;
};

}  // namespace lightnet
