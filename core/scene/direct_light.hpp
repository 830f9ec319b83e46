// Direct light at a surface point, by next-event estimation and by the BSDF: what operators of light share.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/surfaces/heuristic.hpp"

namespace lightnet {

/// What is left of light after that distance in something that absorbs: Beer and Lambert's law. `absorption` per metre,
/// null: nothing absorbs. What has no end, as behind a solid that has a hole, absorbs nothing.
Rgb left_after(const Rgb* absorption, float distance);

/// What a ray into `direction` passes through from a surface, when light arrived there through `arriving` from
/// `outgoing`: what the surface is filled with; on the viewer's side what was there; else nothing.
inline const Rgb* filling(const Bsdf& bsdf, const SurfacePoint& point, Vec3 outgoing, Vec3 direction,
                          const Rgb* arriving) {
    if (const Rgb* own = bsdf.absorption(direction)) return own;
    if (!arriving) return nullptr;
    const bool same_side = (dot(outgoing, point.normal) > 0) == (dot(direction, point.normal) > 0);
    return same_side ? arriving : nullptr;
}

/// Says how directions are sampled at a point where that is not by its BSDF alone.
class Guidance {
public:
    /// Density with which `direction` is found, per steradian. `bsdf`: that of the BSDF alone.
    virtual float pdf(Vec3 direction, float bsdf) const = 0;

protected:
    ~Guidance() = default;
};

/// A point as its light is gathered.
struct Gathering {
    const SurfacePoint& point;
    const Bsdf& bsdf;
    Vec3 outgoing;
    std::uint8_t lobes;
    const Rgb* inside = nullptr;         // what lies between it and the viewer
    const Guidance* guidance = nullptr;  // of directions; null: by the BSDF
};

/// Where light is looked for, so that a surface sends it on to `outgoing`.
inline LitPoint lit_point(Vec3 position, Vec3 normal, Vec3 outgoing, ShutterTime time) {
    return {position, dot(outgoing, normal) > 0 ? normal : -normal, time};
}
inline LitPoint lit_point(const Gathering& at) {
    // What gloss sends on doesn't go by the cosine.
    const bool by_cosine = !(at.bsdf.lobes() & lobe::glossy) && at.bsdf.opaque();
    const SurfacePoint& point = at.point;
    return by_cosine ? lit_point(point.position, point.normal, at.outgoing, point.time)
                     : LitPoint(point.position, point.time);
}

/// What one sampled light sends to a surface point and on, if nothing is in the way of the ray.
struct LampRay {
    Ray ray;
    Rgb light;
    std::uint32_t group = 0;  // of the lamp
};

/// The random numbers that choose a light and a point on it.
struct LampNumbers {
    float choice = 0;  // of no use unless there are many lamps
    Vec2 place;
};

/// Radiance that one sampled light sends to `at` and on into its direction, if nothing is in the way: a point of a
/// lamp, a bare light or a part of the environment; weighted against finding it by a direction from the BSDF. None: no
/// light by this sample, whatever is in between.
std::optional<LampRay> ray_to_lamp(const Scene& scene, const Gathering& at, const LampNumbers& numbers,
                                   Heuristic heuristic);
/// Radiance that a light sends to `at` and on, if nothing is in the way: one that was sampled for lit_point(at), which
/// finds_lamps().
std::optional<LampRay> ray_to_lamp(const Scene& scene, const Gathering& at, const LightSample& lamp,
                                   Heuristic heuristic);
/// Can light from a sampled lamp be sent on?
inline bool finds_lamps(const Scene& scene, const Gathering& at) {
    return !scene.lights().empty() && (at.lobes & at.bsdf.lobes() & lobe::rough);
}

/// Radiance that arrives from where a ray into `sample.incoming` ended (nothing there: the environment), times the
/// weight of having found it by the BSDF, at the lit_point() `from`. Without the sample's own weight.
Rgb light_by_bsdf(const Scene& scene, const LitPoint& from, const BsdfSample& sample, const SurfacePoint* end,
                  Heuristic heuristic);
/// Radiance from a lamp that emits so much towards the point, times the weight of having found it by the BSDF, where
/// sampling lights finds it with density `other`.
Rgb lamp_by_bsdf(Rgb emitted, float pdf, float other, Heuristic heuristic);
/// Radiance from beyond the scene on a ray that met nothing, times the weight of having found it by the BSDF; `sky` is
/// what lies there: of the environment, or of suns.
Rgb sky_by_bsdf(const SkyRadiance& sky, const BsdfSample& sample, Heuristic heuristic);

}  // namespace lightnet
