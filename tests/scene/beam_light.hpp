// Beam: parallel light out of a round opening. The example of a light in CONTRIBUTING.md.
#pragma once

#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/math/shutter.hpp"
#include "core/scene/bare_lights/near_light.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

struct BeamLight {
    static constexpr const char* name = "beam";
    Vec3 position, axis{0, 0, 1};  // axis: unit
    Rgb irradiance;                // W·m⁻², across the axis
    float radius = 1;              // metres
    LampLabel label{};

    const char* names() const { return "beams"; }
    Rgb& strength() { return irradiance; }
    Vec3 aim() const { return axis; }
    bool stands_as(const BeamLight& other) const { return position == other.position && axis == other.axis; }
    BeamLight between(const StepPlace& place, const BeamLight& later) const {
        BeamLight then = *this;
        then.position = place.between(position, later.position);
        then.axis = normalize(place.between(axis, later.axis));
        return then;
    }
    BeamLight ready() const { return *this; }

    std::optional<LightSample> from(Vec3 at) const {
        const float along = dot(at - position, axis);
        const Vec3 start = at - axis * along;
        if (!(along > 0) || !(length(start - position) < radius)) return {};
        return LightSample{start, -axis, irradiance, 1, true, false};
    }
    LightBounds bounds() const {
        const Vec3 around{radius, radius, radius};
        return {position - around, position + around, axis, 1, 0, luminance(irradiance) * radius * radius, false};
    }
    Rgb power() const { return irradiance * (pi * radius * radius); }
    Emission emission(Vec2 u) const {
        const Frame frame = Frame::around(axis);
        const Vec2 at = disk(u);
        return {position + (frame.x * at.x + frame.y * at.y) * radius, axis, power()};
    }
};
void visit_members(Is<BeamLight> auto& light, const auto& visit) {
    auto& [position, axis, irradiance, radius, label] = light;
    visit(position, axis, irradiance, radius);
}

}  // namespace lightnet
