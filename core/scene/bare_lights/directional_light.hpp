// Light from infinity out of one direction, or out of a disk of them.
#pragma once

#include "core/base/math/frame.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/lamp_label.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

/// A cone of directions out of which comes the same radiance.
struct SunDisk {
    Frame axes;      // z: towards its middle
    float drop = 0;  // 1 - cosine of its angle; 0: one direction only
    Rgb radiance;
    Rgb total;          // ∫ radiance dω: irradiance, were all its light to arrive head-on, W·m⁻²
    float density = 0;  // of its directions, per steradian
};

/// From infinity. With an angle it is a disk in the sky, a sun, which rays can meet. A bare light: see IsLight for what
/// its functions say.
struct DirectionalLight {
    static constexpr const char* name = "sun";
    Vec3 direction{0, 0, -1};  // in which its middle shines, unit
    Rgb irradiance;            // W·m⁻², on a plane across it
    LampLabel label{};
    float half_angle = 0;  // radians, from the middle of the disk to its rim, below π/2; 0: one direction only

    const char* names() const { return half_angle > 0 ? "suns" : "directions"; }
    Rgb& strength() { return irradiance; }
    SunDisk disk() const;
};
void visit_members(Is<DirectionalLight> auto& light, const auto& visit) {
    auto& [direction, irradiance, label, half_angle] = light;
    visit(direction, irradiance, half_angle);
}

}  // namespace lightnet
