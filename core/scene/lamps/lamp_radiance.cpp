#include "core/scene/lamps/lamp_radiance.hpp"

#include "core/scene/textures/look_up.hpp"

namespace lightnet {

Rgb LampRadiance::texture_at(std::uint32_t shape, std::uint32_t primitive, float u, float v) const {
    return look_up(data_.textures, *data_.shapes[shape].emission->texture, shading_.place(shape, primitive, u, v));
}

Rgb LampRadiance::towards(const SurfacePoint& point, Vec3 direction) const {
    const AreaEmission& emission = *data_.shapes[point.geometry].emission;
    if (!emission.two_sided && !(dot(point.normal, direction) > 0)) return {};
    if (!emission.texture) return emission.radiance;
    return emission.radiance * texture_at(point.geometry, point.primitive, point.u, point.v);
}

Rgb LampRadiance::at(const LampSource& source, const PointOnLamp& point) const {
    if (!has_texture(source)) return source.radiance;
    return source.radiance * texture_at(source.shape, point.primitive, point.u, point.v);
}

bool LampRadiance::is_there(const LampSource& source, const PointOnLamp& point) const {
    return source.unseen || !shading_.has_holes(source.shape) ||
           shading_.is_there(source.shape, point.primitive, point.u, point.v);
}

}  // namespace lightnet
