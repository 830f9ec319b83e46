#include "core/estimate/through_panes.hpp"

#include <algorithm>
#include <optional>

namespace lightnet {
namespace {

// What is left of light that goes straight through; none: the pane lets none through.
std::optional<Rgb> part_left(const Bsdf& pane, Vec3 outgoing) {
    const auto chance = pane.reflection_chance(outgoing);
    if (!chance) return {};
    const auto sample = pane.sample(outgoing, (1 + *chance) / 2, {}, lobe::specular);
    if (!sample || !sample->transmitted) return {};
    return sample->weight * (1 - *chance);
}

// DECISIONS: panes-are-passed
// What arrives of light on a ray; none: something else than panes is in its way.
std::optional<Rgb> through_panes(const Scene& scene, Ray ray) {
    constexpr int most = 256;
    Rgb left{1, 1, 1};
    for (int i = 0; i < most; ++i) {
        const auto hit = scene.intersect(ray);
        if (!hit) return left;
        if (!scene.column_shapes()[hit->geometry].pane) return {};
        const SurfacePoint point = scene.surface(*hit);
        const auto part = part_left(scene.bsdf(point), -ray.direction);
        if (!part || is_black(*part)) return {};
        left *= *part;
        Ray beyond = point.ray_towards(ray.direction);
        beyond.far = ray.far - dot(beyond.origin - ray.origin, ray.direction);
        if (!(beyond.far > 0)) return left;
        ray = beyond;
    }
    return {};
}

}  // namespace

bool has_panes(const Scene& scene) {
    return std::ranges::any_of(scene.column_shapes(), [](const ColumnShape& shape) { return shape.pane; });
}

void pass_through_panes(const Scene& scene, bool only, std::span<std::uint8_t> occluded, ShadowRays& rays) {
    for (std::size_t i = 0; i < occluded.size(); ++i) {
        if (!occluded[i]) {
            occluded[i] = only;
            continue;
        }
        if (is_black(rays.light[i])) continue;
        const auto part = through_panes(scene, rays.rays[i]);
        if (!part) continue;
        occluded[i] = 0;
        rays.light[i] *= *part;
    }
}

}  // namespace lightnet
