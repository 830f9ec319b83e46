// Radiance of points on lamps.
#pragma once

#include <cstdint>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/lamps/lamp_sources.hpp"
#include "core/scene/surfaces/shading.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

/// A point on a lamp, by its primitive and its place there.
struct PointOnLamp {
    Vec3 position, normal;
    std::uint32_t primitive = 0;
    float u = 0, v = 0;
};

/// By textures and holes of the scene. Looks at data and shading while it lives; any thread may ask.
class LampRadiance {
public:
    LampRadiance(const SceneData& data, const Shading& shading) : data_(data), shading_(shading) {}

    /// What a lamp emits at a point of it.
    Rgb at(const LampSource& source, const PointOnLamp& point) const;
    /// What a point of a surface that shines emits into `direction` (unit, away from it).
    Rgb towards(const SurfacePoint& point, Vec3 direction) const;
    /// Where a mask has holes a lamp does not shine, unless there is nothing of it to be seen.
    bool is_there(const LampSource& source, const PointOnLamp& point) const;
    bool has_texture(const LampSource& source) const {
        return data_.shapes[source.shape].emission->texture.has_value();
    }
    /// The factor that a texture has at a point.
    Rgb texture_at(std::uint32_t shape, std::uint32_t primitive, float u, float v) const;
    const Shading& shading() const { return shading_; }

private:
    const SceneData& data_;
    const Shading& shading_;
};

}  // namespace lightnet
