// The surface that is nearest to a point.
#pragma once

#include <optional>
#include <span>

#include "core/scene/data/scene_data.hpp"
#include "core/scene/shapes/ray.hpp"
#include "core/scene/surfaces/shading.hpp"

struct RTCSceneTy;

namespace lightnet {

struct Form;

/// Which surface is meant.
struct SurfaceWish {
    Vec3 position;    // world space
    Vec3 normal;      // unit, on either side of the surface; zero: that is not known
    float reach = 0;  // scene units; what lies farther away is not meant
};

/// Where surfaces are looked for.
struct PlacedSurfaces {
    const SceneData& data;
    const Shading& shading;
};

/// The surface point that fits best: that is near, and lies as the normal says. A surface at right angles to the normal
/// counts as farther away, by `reach`. None: nothing lies within reach. The same for every processor and every tree.
std::optional<Hit> nearest_surface(RTCSceneTy* tree, std::span<const Form> forms, const PlacedSurfaces& surfaces,
                                   const SurfaceWish& wish);

}  // namespace lightnet
