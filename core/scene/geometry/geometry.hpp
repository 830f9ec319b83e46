// Shapes as rays meet them. The home of Embree is this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/base/math/box.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/geometry/nearest_surface.hpp"
#include "core/scene/shapes/ray.hpp"
#include "core/scene/surfaces/shading.hpp"

namespace lightnet {

/// The shapes of a scene and the instances of its objects, ready for rays. Every member may be called from any thread.
/// A hit depends on its ray and on the shapes alone: not on the rays beside it, nor on how many threads the host has.
/// Shapes of no material are not there; where others have holes, rays go through.
class Geometry {
public:
    /// How the trees (bounding volume hierarchies, BVHs) are built.
    struct Options {
        std::string isa = "avx2";                       // Embree's instruction set
        std::uint32_t threads = 0;                      // that build; 0: one per core
        std::size_t quads_from = std::size_t{1} << 19;  // triangles of a scene from which they are paired
    };
    /// Keeps looking at both, which must stay as they are. Pads each mesh's positions by one element.
    Geometry(SceneData& data, const Shading& shading, const Options& options);
    ~Geometry();
    Geometry(const Geometry&) = delete;
    Geometry& operator=(const Geometry&) = delete;

    std::optional<Hit> intersect(const Ray& ray) const;
    void intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;
    bool occluded(const Ray& ray) const;
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const;

    /// What is nearest to a point, see nearest_surface(). `surfaces` are those that it was made of.
    std::optional<Hit> nearest(const PlacedSurfaces& surfaces, const SurfaceWish& wish) const;

    /// Around all that rays can meet.
    Box bounds() const;
    /// Bytes of the trees, and of what pairs triangles for them. Vertices and triangles are not copied.
    std::size_t memory() const;

    static std::uint64_t rays_of_this_thread();

private:
    struct Tracer;
    std::unique_ptr<Tracer> tracer_;
};

}  // namespace lightnet
