// Sees which rays are traced, to tell afterwards how a pixel came about.
#pragma once

#include <optional>

#include "core/scene/shapes/ray.hpp"

namespace lightnet {

/// Is told of every ray that a scene traces on a thread that it watches, in their order; it changes none.
class RayWitness {
public:
    virtual ~RayWitness() = default;
    /// Which surface the ray meets first, if any.
    virtual void met(const Ray& ray, const std::optional<Hit>& hit) = 0;
    /// Whether anything is in the ray's way.
    virtual void looked(const Ray& ray, bool hidden) = 0;
};

/// From now on rays of the calling thread are told to `witness`; null: to nobody. Returns who was told before.
RayWitness* watch_rays(RayWitness* witness);

}  // namespace lightnet
