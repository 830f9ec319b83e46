// A point that throws a picture, as a slide projector does.
#pragma once

#include <memory>
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
    Rgb power() const { return weights_ ? spot_.intensity * weights_->power : Rgb{}; }
    /// See IsNearLight.
    std::optional<LightSample> from(Vec3 at) const;
    LightBounds bounds() const;
    /// Light leaving it, by how bright the slide is there; flux as if it were the only light.
    Emission emission(Vec2 u) const;

    Vec3 position;
    LampLabel label;

private:
    /// What all spots share that throw the same picture the same way, however bright and wherever they stand.
    struct Weights {
        std::shared_ptr<const Image> image;
        std::vector<float> rows;     // share of all light up to and with each row of pixels
        std::vector<float> columns;  // by row: share of the row's light up to and with each
        Rgb power;                   // W, of an intensity of 1
    };
    /// What passes of an intensity of 1 at a place on the plane at distance 1 (x and y), in the slide's own axes.
    Rgb passed(Vec2 plane) const;
    Vec2 plane_of(double column, double row) const;
    Vec3 local(Vec3 direction) const;
    Weights weigh() const;

    SpotLight spot_;
    Slide slide_;
    Vec3 x_, y_, z_;                          // the slide's axes in world space
    std::shared_ptr<const Weights> weights_;  // null: no picture
};

}  // namespace lightnet
