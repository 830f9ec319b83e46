// Points that shine: alike in all directions, or by a pattern.
#pragma once

#include <optional>
#include <variant>

#include "core/base/math/rgb.hpp"
#include "core/base/math/shutter.hpp"
#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/environment_data.hpp"
#include "core/scene/bare_lights/lamp_label.hpp"
#include "core/scene/bare_lights/near_light.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

struct PatternedLight;

/// A bare light: see IsLight and IsNearLight for what its functions say. The latter speak of it without its pattern.
struct PointLight {
    static constexpr const char* name = "point";
    Vec3 position;
    Rgb intensity;  // W·sr⁻¹
    LampLabel label{};
    std::optional<EnvironmentData> pattern{};  // times this, by the direction into which it shines
    Matrix luminaire{};                        // turns its own axes, whose straight down is -z, as the file has it

    const char* names() const { return "points"; }
    Rgb& strength() { return intensity; }
    Vec3 aim() const { return {}; }
    bool stands_as(const PointLight& other) const { return position == other.position && intensity == other.intensity; }
    PointLight between(const StepPlace& place, const PointLight& later) const {
        return {place.between(position, later.position), place.between(intensity, later.intensity)};
    }
    std::variant<PointLight, PatternedLight> ready() const;

    std::optional<LightSample> from(Vec3 at) const { return from_point(position, intensity, at); }
    LightBounds bounds() const;
    Rgb power() const;
    Emission emission(Vec2 u) const;
};
void visit_members(Is<PointLight> auto& light, const auto& visit) {
    auto& [position, intensity, label, pattern, luminaire] = light;
    visit(position, intensity, pattern);
}

}  // namespace lightnet
