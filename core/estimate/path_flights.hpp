// Flights of light paths through media, from one of their vertices to the next.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/estimate/path_batch.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/scene_media.hpp"

namespace lightnet::flights {

/// Of the random numbers of flights.
inline constexpr Key key = key_of("flights");

/// Of the path that adds up at `sum`.
inline Vec2 numbers(const PathBatch& batch, std::uint32_t groups, std::uint32_t sum, std::uint32_t dimension) {
    return batch.flights.at(sum / groups, dimension).next_2d();
}

/// What media do to paths on their way to what they would meet. They shine as the sky does: no lamp is looked for in
/// them.
inline void go(const Scene& scene, PathBatch& batch, std::uint32_t groups, std::uint32_t dimension) {
    batch.collisions.resize(batch.paths.size());
    for (std::size_t i = 0; i < batch.paths.size(); ++i) {
        PathBatch::Path& path = batch.paths[i];
        Ray way = batch.rays[i];
        if (batch.hits[i]) way.far = batch.hits[i]->distance;
        const Flight flight = scene.media().fly(way, path.weight, numbers(batch, groups, path.sum, dimension));
        batch.sums[path.sum + scene.lights().environment_group()] += path.weight * flight.emitted;
        path.weight *= flight.weight;
        batch.collisions[i] = flight.collision;
    }
}

/// A path has come to a point in a medium.
inline void collide(PathBatch& batch, std::size_t i) {
    PathBatch::Path& path = batch.paths[i];
    const Collision& at = *batch.collisions[i];
    if (path.inside) path.weight *= left_after(path.inside, at.distance);
    const Ray& ray = batch.rays[i];
    batch.vertices.add_in_space(static_cast<std::uint32_t>(i),
                                {ray.origin + path.incoming * at.distance, at.medium, ray.time}, -path.incoming,
                                lobe::all, path.inside);
}

}  // namespace lightnet::flights
