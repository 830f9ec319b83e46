// Light's way through media, to points that look for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/estimate/shadow_rays.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/scene_media.hpp"

namespace lightnet {

/// Takes from the light of shadow rays what media keep of it, where nothing else is in the way. numbers(sum) gives two
/// random numbers for each ray.
template <class Numbers>
void pass_through_media(const Scene& scene, std::span<const std::uint8_t> occluded, ShadowRays& rays,
                        Numbers&& numbers) {
    for (std::size_t i = 0; i < rays.rays.size(); ++i)
        if (!occluded[i]) rays.light[i] *= scene.media().transmittance(rays.rays[i], numbers(rays.sums[i]));
}

}  // namespace lightnet
