// Cones of light from a point, which may throw a picture.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "core/base/math/rgb.hpp"
#include "core/base/math/shutter.hpp"
#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/lamp_label.hpp"
#include "core/scene/bare_lights/near_light.hpp"
#include "core/scene/textures/image.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

/// A picture that light passes. At distance 1 along z it is 2 half_width wide and 2 half_height high, dark beyond.
struct Slide {
    std::shared_ptr<const Image> image{};
    Matrix to_world{};  // a rotation, perhaps mirrored: x to the picture's right, y down in it, z ahead
    float half_width = 1, half_height = 1;
    bool even_on_planes = false;  // the intensity is divided by cos³, so that white lights planes across z evenly
};
void visit_members(Is<Slide> auto& slide, const auto& visit) {
    auto& [image, to_world, half_width, half_height, even_on_planes] = slide;
    visit(image, to_world, half_width, half_height, even_on_planes);
}

class SlideLight;

/// Full intensity within `inner` of its axis, none beyond `outer` (radians), between them as `falloff` says. A bare
/// light: see IsLight and IsNearLight for what its functions say. The latter speak of it without its slide.
struct SpotLight {
    static constexpr const char* name = "spot";
    Vec3 position, axis{0, 0, 1};  // axis: unit
    Rgb intensity;                 // W·sr⁻¹, on the axis
    float inner = 0, outer = 0;
    enum class Falloff {  // in the cosine but for `linear`, which is in the angle
        smoothstep,
        linear,
        squared_linear,
        fourth_power
    } falloff = Falloff::smoothstep;
    LampLabel label{};
    std::optional<Slide> slide{};  // times this; z is the axis
    Matrix luminaire{};            // as that of a point, which shines straight down along the axis

    const char* names() const { return "spots"; }
    Rgb& strength() { return intensity; }
    Vec3 aim() const { return axis; }
    bool stands_as(const SpotLight& other) const;
    SpotLight between(const StepPlace& place, const SpotLight& later) const;
    std::variant<SpotLight, SlideLight> ready() const;

    /// Share of its full intensity that it sends at an angle from its axis, given by the cosine.
    float share_at(float cosine) const;

    std::optional<LightSample> from(Vec3 at) const;
    LightBounds bounds() const;
    Rgb power() const;
    Emission emission(Vec2 u) const;
};
void visit_members(Is<SpotLight> auto& light, const auto& visit) {
    auto& [position, axis, intensity, inner, outer, falloff, label, slide, luminaire] = light;
    visit(position, axis, intensity, inner, outer, falloff, slide);
}

}  // namespace lightnet
