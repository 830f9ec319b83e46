// Surface points made ready for shading, from their names.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/shapes/ray.hpp"
#include "core/scene/shapes/shape.hpp"
#include "core/scene/surfaces/column_shape.hpp"
#include "core/scene/surfaces/materials.hpp"
#include "core/scene/surfaces/moving_shape.hpp"
#include "core/scene/surfaces/placement.hpp"
#include "core/scene/surfaces/surface.hpp"
#include "core/scene/textures/look_up.hpp"

namespace lightnet {

/// The surfaces of a scene. Any thread may ask.
class Shading {
public:
    /// Keeps looking at `data`. `before`: of a scene whose shapes are the same (see have_same_shapes()), from which
    /// what hangs on shapes alone is taken; null: there is none. Throws Error as Materials does.
    explicit Shading(const SceneData& data, const Shading* before = nullptr);

    /// The point with these coordinates (see Query) on a primitive of a shape, as the shape was made.
    SurfacePoint point(std::uint32_t geometry, std::uint32_t primitive, float u, float v, ShutterTime time = 0) const {
        SurfacePoint point;
        point.time = time;
        find(geometry, primitive, u, v, point);
        return point;
    }
    /// The point of a hit, in world space, put where it is wanted: copies of what has just been written wait for it.
    void find(const Hit& hit, SurfacePoint& point) const;
    /// The shading normal there by bumps, if the shape has any.
    Vec3 bumpy_normal(const SurfacePoint& point) const;
    /// By instance; of one that moves, where it stands at first.
    std::span<const Placement> placements() const { return placements_; }
    /// Of an instance that moves, its places at later steps; of others none.
    std::span<const Placement> later_placements(std::uint32_t instance) const;
    /// How a shape moves; null: it stands still.
    const MovingShape* moving(std::uint32_t geometry) const {
        return needs_[geometry].moving == none ? nullptr : &moving_[needs_[geometry].moving];
    }
    /// Fetches what find() will read of them from memory.
    void expect(std::span<const std::optional<Hit>> hits) const;
    Bsdf bsdf(const SurfacePoint& point) const;
    /// Those of many, appended.
    void add_bsdfs(std::span<const SurfacePoint> points, std::vector<Bsdf>& to) const;
    /// By shape.
    std::span<const ColumnShape> column_shapes() const { return column_shapes_; }
    /// Bsdf::lobes() all over a shape; 0: they are not the same everywhere.
    std::uint8_t lobes(std::uint32_t geometry) const { return needs_[geometry].lobes; }
    /// Reflectance of a Lambertian one, there.
    Rgb albedo(std::uint32_t geometry, const TexturePlace& place) const {
        return materials_.albedo(data_.shapes[geometry].material, place);
    }
    /// How one scatters there whose models are of this one kind alone.
    template <class Model>
    Model model(std::uint32_t geometry, const TexturePlace& place) const {
        return materials_.model<Model>(data_.shapes[geometry].material, place);
    }
    /// Fetches from memory what is read of pictures there, by albedo() or bsdf().
    [[gnu::always_inline]] void expect_pictures(std::uint32_t geometry, Vec2 uv) const {
        materials_.expect(data_.shapes[geometry].material, uv);
    }

    /// What textures may depend on there, by the same coordinates, of a shape as it was made.
    TexturePlace place(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const;
    /// What textures may depend on there, but for where the point is.
    TexturePlace coordinates(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const;
    /// How points of a shape are found.
    const PlacedShape& placed(std::uint32_t geometry) const { return placed_[geometry]; }
    /// Can rays go through the shape? Only then the next two need to be asked.
    bool has_holes(std::uint32_t geometry) const { return needs_[geometry].material.holes; }
    /// Share of the light that meets the surface there, 0 … 1.
    float opacity_at(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const;
    /// Does a ray that arrives there meet anything? Where opacity lies between 0 and 1, a hash of the four numbers
    /// decides, so that the answer is the same for every ray, in every mode and on every host.
    bool is_there(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const;

private:
    static constexpr std::uint32_t none = 0xffffffffu;
    struct Needs {
        MaterialNeeds material;
        float offset = 0;             // least distance by which rays must leave the shape, m
        const Mesh* mesh = nullptr;   // null: the shape is another
        std::uint8_t lobes = 0;       // 0: not the same everywhere
        bool place = false;           // textures of opacity or emission depend on where a point is
        std::uint32_t moving = none;  // into moving_
        std::vector<float> turned{};  // by triangle: see triangle_offset_at(); empty: none is more than `offset`
    };
    void find(std::uint32_t geometry, std::uint32_t primitive, float u, float v, SurfacePoint& point) const;
    ColumnShape column_shape(const Shape& shape, const Needs& needs) const;
    void find_on(const Mesh* mesh, const Needs& needs, SurfacePoint& point) const;
    void find_on(const Sphere* sphere, const Needs& needs, SurfacePoint& point) const;
    void find_on(const PlacedQuadric& quadric, const Needs& needs, SurfacePoint& point) const;
    void find_on(const Curves* curves, const Needs& needs, SurfacePoint& point) const;
    void find_moving(const MovingShape& shape, const Needs& needs, SurfacePoint& point) const;
    /// A triangle as it stands at some time.
    struct Standing {
        Corners at, normals;  // no shading normals: nothing
        float turned;         // see triangle_offset_at()
    };
    void find_on(const Mesh& mesh, const Standing& triangle, const Needs& needs, SurfacePoint& point) const;
    /// Adds what textures, grooves and bumps need.
    void dress(const Mesh& mesh, const Corners& at, const Needs& needs, SurfacePoint& point) const;
    Placement placement(const Hit& hit) const;
    void take_motion();

    const SceneData& data_;
    Materials materials_;
    std::vector<Placement> placements_;  // by instance
    std::vector<MovingShape> moving_;
    std::vector<std::vector<Placement>> moved_placements_;  // of instances that move
    std::vector<std::uint32_t> moved_instances_;            // by instance, where any moves: into those, or none
    std::vector<Needs> needs_;                              // by shape
    std::vector<ColumnShape> column_shapes_;
    std::vector<PlacedShape> placed_;  // by shape
};

}  // namespace lightnet
