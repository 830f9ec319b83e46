// One sample of direct light, for tests.
#pragma once

#include "core/base/math/samples.hpp"
#include "core/scene/direct_light.hpp"

namespace lightnet::test {

/// Radiance that one sample of a point on a lamp, and one of a direction, find for who looks from straight above.
inline Rgb both_ways(const Scene& scene, const SurfacePoint& point, const Bsdf& bsdf, Samples samples) {
    const Vec3 up{0, 1, 0};
    const float choice = samples.next();
    const Gathering at{point, bsdf, up, lobe::all};
    const auto lamp = ray_to_lamp(scene, at, {choice, samples.next_2d()}, Heuristic::power);
    Rgb light = lamp && !scene.occluded(lamp->ray) ? lamp->light : Rgb{};
    const auto way = bsdf.sample(up, 0, samples.next_2d(), lobe::all);
    const auto hit = scene.intersect({point.origin_towards(way->incoming), way->incoming});
    SurfacePoint end;
    if (hit) end = scene.surface(*hit);
    light += way->weight * light_by_bsdf(scene, lit_point(at), *way, hit ? &end : nullptr, Heuristic::power);
    return light;
}

}  // namespace lightnet::test
