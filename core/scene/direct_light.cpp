#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"

#include <cmath>

namespace lightnet {

Rgb left_after(const Rgb* absorption, float distance) {
    if (!absorption || !std::isfinite(distance)) return {1, 1, 1};
    return {std::exp(-absorption->r * distance), std::exp(-absorption->g * distance),
            std::exp(-absorption->b * distance)};
}

namespace {

// Weight of a direction from the BSDF, with density `mine`; `other` is that of finding the same by a point on a lamp.
float direction_share(Heuristic heuristic, bool from_infinity, float mine, float other) {
    if (heuristic == Heuristic::lamps) return other == 0 ? 1 : 0;
    return heuristic == Heuristic::directions ? 1 : share(squares(heuristic, from_infinity), mine, other);
}

}  // namespace

std::optional<LampRay> ray_to_lamp(const Scene& scene, const Gathering& at, const LampNumbers& numbers,
                                   Heuristic heuristic) {
    if (!finds_lamps(scene, at)) return {};
    const auto lamp = scene.lights().sample(lit_point(at), numbers.choice, numbers.place);
    return lamp ? ray_to_lamp(scene, at, *lamp, heuristic) : std::nullopt;
}

std::optional<LampRay> ray_to_lamp(const Scene& scene, const Gathering& at, const LightSample& lamp,
                                   Heuristic heuristic) {
    if (!lamp.bare && heuristic == Heuristic::directions) return {};
    const auto [value, bsdf_pdf] = at.bsdf.value_and_pdf(at.outgoing, lamp.direction, at.lobes);
    if (is_black(value)) return {};
    const float pdf = at.guidance ? at.guidance->pdf(lamp.direction, bsdf_pdf) : bsdf_pdf;
    const bool alone = lamp.bare || heuristic == Heuristic::lamps;
    const float weight = alone ? 1 : share(squares(heuristic, lamp.from_infinity), lamp.pdf, pdf);
    const Ray ray = scene.ray_to(at.point, lamp);
    Rgb light = value * lamp.radiance * (weight / lamp.pdf);
    if (const Rgb* inside = filling(at.bsdf, at.point, at.outgoing, ray.direction, at.inside))
        light *= left_after(inside, ray.far);
    return LampRay{ray, light, lamp.group};
}

// What a specular surface sends on can't be found by a sampled light.
Rgb sky_by_bsdf(const SkyRadiance& sky, const BsdfSample& sample, Heuristic heuristic) {
    const float other = sample.lobe == lobe::specular ? 0 : sky.pdf;
    return is_black(sky.radiance) ? Rgb{} : sky.radiance * direction_share(heuristic, true, sample.pdf, other);
}

Rgb lamp_by_bsdf(Rgb emitted, float pdf, float other, Heuristic heuristic) {
    return emitted * direction_share(heuristic, false, pdf, other);
}

Rgb light_by_bsdf(const Scene& scene, const LitPoint& from, const BsdfSample& sample, const SurfacePoint* end,
                  Heuristic heuristic) {
    if (!end) {
        SkyRadiance sky;
        const Ray ray{from.position, sample.incoming, Ray().far, from.time};
        scene.lights().look_at_sky({&ray, 1}, {&sky, 1});
        const auto sun = scene.lights().sun(sample.incoming);
        const Rgb light = sky_by_bsdf(sky, sample, heuristic);
        return sun ? light + sky_by_bsdf(sun->light, sample, heuristic) : light;
    }
    const Rgb emitted = scene.lights().emission(*end, -sample.incoming);
    if (is_black(emitted)) return {};
    const float other = sample.lobe == lobe::specular ? 0 : scene.lights().pdf(from, sample.incoming, *end);
    return lamp_by_bsdf(emitted, sample.pdf, other, heuristic);
}

}  // namespace lightnet
