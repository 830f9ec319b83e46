// A point of a surface, with all that shading needs to know of it.
#pragma once

#include <cstdint>

#include "core/base/math/frame.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/base/query.hpp"
#include "core/scene/shapes/offset.hpp"
#include "core/scene/shapes/ray.hpp"
#include "core/scene/textures/look_up.hpp"

namespace lightnet {

struct Mesh;

/// Derived from a Hit or a Query alone, so it's the same on every host. What no texture, groove or bump of the shape
/// needs is left as it is here. A point in a medium has a position alone, and `primitive` is the index of its medium.
struct SurfacePoint {
    Vec3 position;               // world space
    Vec3 normal;                 // geometric, unit; the side on which a one-sided lamp shines
    Frame shading;               // z: shading normal, on the side of `normal`
    Vec2 uv;                     // texture coordinates
    const Mesh* mesh = nullptr;  // whose vertices know more; null: it is none of those
    Rgb vertex_colour{1, 1, 1};  // of the mesh, interpolated
    Vec3 along_u, along_v;       // ∂position/∂u and ∂position/∂v, metres
    std::uint32_t geometry = 0;  // index into the scene's shapes; Query::in_space: the point is on none
    std::uint32_t primitive = 0;
    float u = 0, v = 0;    // on the primitive, as in its Hit
    float offset = 0;      // metres: beyond the rounding errors of `position`
    ShutterTime time = 0;  // at which it is there

    bool is_in_space() const { return geometry == Query::in_space; }
    /// Where a ray into `direction` starts: off the surface, on the side into which it goes.
    Vec3 origin_towards(Vec3 direction) const;
    /// The ray from there.
    Ray ray_towards(Vec3 direction) const { return {origin_towards(direction), direction, Ray().far, time}; }
};

/// A place on a triangle of a mesh, by the weights of its second and its third corner.
BetweenVertices between_vertices(const Mesh& mesh, std::uint32_t triangle, float u, float v);

/// What its textures may depend on.
inline TexturePlace place_of(const SurfacePoint& point) {
    TexturePlace place{point.uv, point.vertex_colour, point.position, point.normal};
    if (point.mesh) place.vertices = between_vertices(*point.mesh, point.primitive, point.u, point.v);
    return place;
}

inline Vec3 SurfacePoint::origin_towards(Vec3 direction) const {
    return off_surface(position, normal, offset, direction);
}

}  // namespace lightnet
