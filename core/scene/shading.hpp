// From the name of a surface point to all that shading needs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/bsdf/bsdf.hpp"
#include "core/scene/scene_data.hpp"
#include "core/scene/surface.hpp"
#include "core/scene/textures.hpp"

namespace lightnet {

/// The surfaces of a scene. Any thread may ask.
class Shading {
public:
    /// Keeps looking at `data`. Throws Error where a material names a texture that isn't there.
    explicit Shading(const SceneData& data);

    /// The point with these coordinates (see Query) on a primitive of a shape.
    SurfacePoint point(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const;
    Bsdf bsdf(const SurfacePoint& point) const;

    /// What textures may depend on there, by the same coordinates.
    TexturePlace place(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const;
    /// Can rays go through the shape? Only then the next two need to be asked.
    bool has_holes(std::uint32_t geometry) const { return needs_[geometry].holes; }
    /// Share of the light that meets the surface there, 0 … 1.
    float opacity_at(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const;
    /// Does a ray that arrives there meet anything? Where opacity lies between 0 and 1, a hash of the four numbers
    /// decides, so that the answer is the same for every ray, in every mode and on every host.
    bool is_there(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const;

private:
    struct Needs {
        bool uv = false;       // an image is looked up
        bool tangent = false;  // roughness depends on the direction
        bool holes = false;    // opacity is below 1 somewhere
        float offset = 0;      // least distance by which rays must leave the shape, m
    };
    SurfacePoint on_mesh(const Mesh& mesh, Needs needs, std::uint32_t primitive, float u, float v) const;
    SurfacePoint on_sphere(const Sphere& sphere, Needs needs, float u, float v) const;
    Bsdf::Model model_at(std::uint32_t material, Vec2 uv) const;

    const SceneData& data_;
    std::vector<Needs> needs_;                        // by shape
    std::vector<std::unique_ptr<const Coat>> coats_;  // by material
    std::vector<std::optional<Bsdf::Model>> plain_;   // by material: the same everywhere, as no image is looked up
};

}  // namespace lightnet
