// Light from infinity as a scene has it.
#pragma once

#include <memory>
#include <optional>

#include "core/base/math/rgb.hpp"
#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/textures/image.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

/// A rectangle in world space through which light from infinity comes, and nowhere else: a window. Towards that light
/// it is crossed along side × other.
struct Portal {
    Vec3 corner, side, other;  // the latter two: from that corner to those beside it

    /// Does a ray go out through it?
    bool passes(Vec3 origin, Vec3 direction) const { return density(origin, direction) > 0; }
    /// Of directions (unit) to evenly distributed points of it, sr⁻¹; 0 where they don't go out.
    float density(Vec3 origin, Vec3 direction) const {
        const Vec3 out = cross(side, other);
        const float along = dot(direction, out);
        if (!(along > 0)) return 0;
        const float distance = dot(corner - origin, out) / along;
        const Vec3 from_corner = origin + direction * distance - corner;
        const float a = dot(from_corner, side), b = dot(from_corner, other);
        const bool inside = a >= 0 && a <= dot(side, side) && b >= 0 && b <= dot(other, other);
        return distance > 0 && inside ? distance * distance / along : 0;
    }
    Vec3 at(Vec2 u) const { return corner + side * u.x + other * u.y; }
};
void visit_members(Is<Portal> auto& portal, const auto& visit) {
    auto& [corner, side, other] = portal;
    visit(corner, side, other);
}

/// Light from infinity: `radiance` (W·sr⁻¹·m⁻²), or an image times it.
struct EnvironmentData {
    Rgb radiance{1, 1, 1};
    std::shared_ptr<const Image> image{};
    enum class Layout { latitude_longitude, equal_area } layout = Layout::latitude_longitude;
    Matrix to_world{};  // a rotation. Latitude-longitude: +y is the top row, -z the picture's middle, +x right of it.
                        // Equal area: the octahedral map of Clarberg (2008) as pbrt lays it out: +z is the centre.
    std::optional<Portal> portal{};  // none: it is seen from everywhere
};
void visit_members(Is<EnvironmentData> auto& environment, const auto& visit) {
    auto& [radiance, image, layout, to_world, portal] = environment;
    visit(radiance, image, layout, to_world, portal);
}

}  // namespace lightnet
