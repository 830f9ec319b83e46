// What rays meet. The only home of Embree is the .cpp of this header.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/ray.hpp"
#include "core/scene/scene_data.hpp"

namespace lightnet {

/// The shapes of a scene, ready for rays. Every member may be called from any thread. A hit depends on its ray and on
/// the shapes alone: not on the rays beside it, nor on how many threads the host has.
class Geometry {
public:
    /// Keeps looking at `shapes`, which must stay as they are. Pads each mesh's positions by one element.
    Geometry(std::vector<Shape>& shapes, const std::string& isa);
    ~Geometry();
    Geometry(const Geometry&) = delete;
    Geometry& operator=(const Geometry&) = delete;

    std::optional<Hit> intersect(const Ray& ray) const;
    void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;
    bool occluded(const Ray& ray) const;
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const;

    struct Box {
        Vec3 lower, upper;
    };
    Box bounds() const;

    static std::uint64_t rays_of_this_thread();

private:
    struct Tracer;
    std::unique_ptr<Tracer> tracer_;
};

}  // namespace lightnet
