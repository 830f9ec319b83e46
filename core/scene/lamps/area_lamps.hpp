// Shapes that shine: points on them, and how likely each is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/base/lamp_groups.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/lamps/ball_lamp.hpp"
#include "core/scene/lamps/lamp_balls.hpp"
#include "core/scene/lamps/light_tree.hpp"
#include "core/scene/lamps/lit_point.hpp"
#include "core/scene/shapes/ray.hpp"
#include "core/scene/surfaces/flat_lamp.hpp"
#include "core/scene/surfaces/shading.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

/// All shapes that emit light, cut into lamps: a sphere or quadric is one, all curves of a shape are one, and so is a
/// mesh of a few triangles in one plane; of any other mesh each triangle is. A point on a mesh is uniform by area, on a
/// sphere uniform within the cone that it fills, on a quadric as SeenQuadric has it, on curves by segment, parameter
/// and turn. Any thread may ask.
class AreaLamps {
public:
    /// Those of some groups, which are told apart or are all one. Looks at data and shading while it lives.
    AreaLamps(const SceneData& data, const Shading& shading, GroupSet groups, bool apart);

    std::size_t size() const { return source_of_.size(); }
    /// A point on a lamp that is chosen for certain. None: it sends no light this way.
    std::optional<LightSample> sample(std::size_t lamp, const LitPoint& from, Vec2 u) const;
    /// Fetches what sample() will read of some lamps from memory.
    void expect(std::span<const LightChoice> chosen) const;
    /// A uniform triangle or parallelogram, or a uniform ball, which many points can look at at once; or nothing of
    /// the kind.
    using EvenLamp = std::variant<std::monostate, FlatLamp, BallLamp>;
    EvenLamp even(std::size_t lamp) const;
    /// What even() gives, kept. Null: there are too many.
    const EvenLamp* known(std::size_t lamp) const { return known_.empty() ? nullptr : &known_[lamp]; }
    /// Density with which sample() finds the emitting point `on`, which lies in `direction` from `from`.
    float pdf(std::size_t lamp, Vec3 from, Vec3 direction, const SurfacePoint& on) const;
    /// The lamp that a point of a surface belongs to.
    std::optional<std::size_t> lamp_at(const SurfacePoint& point) const;
    /// Of the shape that a lamp is: 0 where groups are one.
    std::uint32_t group_of(std::uint32_t shape) const { return apart_ ? data_.shapes[shape].emission->label.group : 0; }
    /// Radiance that a point of a surface emits into `direction` (unit, away from it).
    Rgb radiance(const SurfacePoint& point, Vec3 direction) const;
    /// Does the shape have lamps?
    bool shines(std::uint32_t shape) const { return sources_of_shapes_[shape] != none; }
    /// Could the ray meet a lamp? False is certain.
    bool may_meet(const Ray& ray) const { return balls_.may_meet(ray); }

    LightBounds bounds(std::size_t lamp) const;
    /// All that the lamp emits, W; of a textured one, nearly.
    Rgb power(std::size_t lamp) const;
    /// Light leaving the lamp: uniform by area, by the cosine in direction; flux as if it were the only light.
    std::optional<Emission> emit(std::size_t lamp, Vec2 position_sample, Vec2 direction_sample, ShutterTime time) const;
    std::size_t memory() const;

private:
    static constexpr std::uint32_t none = 0xffffffffu;
    /// A shape that shines: one lamp, or as many as it has triangles.
    struct Source {
        std::uint32_t shape = 0;
        std::uint32_t first_lamp = 0;
        bool by_triangle = false;
        std::uint32_t first = 0, facets = 0;  // of a mesh that is one lamp: into facets_
        float area = 0;                       // m²; of what is one lamp
        Rgb radiance;
        bool two_sided = false;
        bool uniform = true;         // neither texture nor holes
        bool unseen = false;         // by any ray
        std::uint32_t whole = none;  // into wholes_
        std::uint32_t group = 0;
    };
    /// One lamp. What is asked about many is not kept of each: a million of triangles have to fit.
    struct Lamp {
        const Source& source;
        std::uint32_t triangle;  // which, where each is a lamp
        float area;
        ShutterTime time;
    };
    /// A point on a lamp.
    struct PointOnLamp {
        Vec3 position, normal;
        std::uint32_t primitive = 0;
        float u = 0, v = 0;
    };
    /// What begins a light path: `area` is that of the lamp as if all of it were as stretched as there, m².
    struct Start {
        PointOnLamp point;
        float area;
    };
    void add(std::uint32_t shape, const MovingShape& moving);
    void add(std::uint32_t shape, const Mesh* mesh);
    void add(std::uint32_t shape, const Sphere* ball);
    void add(std::uint32_t shape, const PlacedQuadric& quadric);
    void add(std::uint32_t shape, const Curves* curves);
    static std::optional<Facet> parallelogram(const Facet& first, const Facet& second);
    void add_source(std::uint32_t shape, std::uint32_t lamps, std::uint32_t facets);
    /// Calls `use` with the shape that it is at a time.
    template <class Use>
    auto on_shape(const Source& source, ShutterTime time, const Use& use) const {
        if (const MovingShape* moving = shading_.moving(source.shape))
            return moving->placed(part_of_shutter(time), use);
        return std::visit(use, shading_.placed(source.shape));
    }
    template <class Use>
    auto on_shape(const Lamp& lamp, const Use& use) const {
        return on_shape(lamp.source, lamp.time, use);
    }
    /// with(lamp) at each step of its shape's motion; of one that stands still, once.
    template <class With>
    void at_each_step(std::size_t lamp, const With& with) const;
    /// Of what is one lamp for each triangle.
    const Mesh& mesh_of(const Source& source) const { return *std::get<const Mesh*>(shading_.placed(source.shape)); }
    Lamp lamp(std::size_t index, ShutterTime time) const;
    Rgb mean_of_texture(const Lamp& lamp) const;
    Rgb texture_at(std::uint32_t shape, std::uint32_t primitive, float u, float v) const;
    Rgb radiance_at(const Source& source, const PointOnLamp& point) const;
    bool is_there(const Source& source, const PointOnLamp& point) const;
    Facet facet_of(const Lamp& lamp, std::uint32_t& primitive, float& u) const;
    float area(const Source& source, const Mesh* mesh) const;
    float area(const Source& source, const Sphere* ball) const;
    float area(const Source& source, const PlacedQuadric& quadric) const;
    float area(const Source& source, const Curves* curves) const;
    EvenLamp even(const Lamp& lamp, const Mesh* mesh) const;
    EvenLamp even(const Lamp& lamp, const Sphere* ball) const;
    EvenLamp even(const Lamp& lamp, const PlacedQuadric& quadric) const;
    EvenLamp even(const Lamp& lamp, const Curves* curves) const;
    static BallLamp ball_lamp(const Lamp& lamp, const Sphere& ball);
    static PointOnLamp on_sphere(const Sphere& ball, Vec3 outwards);
    static PointOnLamp on_quadric(const PlacedQuadric& quadric, Vec3 own);
    Start start(const Lamp& lamp, const Mesh* mesh, Vec2 u) const;
    Start start(const Lamp& lamp, const Sphere* ball, Vec2 u) const;
    Start start(const Lamp& lamp, const PlacedQuadric& quadric, Vec2 u) const;
    Start start(const Lamp& lamp, const Curves* curves, Vec2 u) const;
    std::optional<LightSample> sample(const Lamp& lamp, const Mesh* mesh, Vec3 from, Vec2 u) const;
    std::optional<LightSample> sample(const Lamp& lamp, const Sphere* ball, Vec3 from, Vec2 u) const;
    std::optional<LightSample> sample(const Lamp& lamp, const PlacedQuadric& quadric, Vec3 from, Vec2 u) const;
    std::optional<LightSample> sample(const Lamp& lamp, const Curves* curves, Vec3 from, Vec2 u) const;
    LightBounds bounds(const Lamp& lamp, const Mesh* mesh, float radiance) const;
    LightBounds bounds(const Lamp& lamp, const Sphere* ball, float radiance) const;
    LightBounds bounds(const Lamp& lamp, const PlacedQuadric& quadric, float radiance) const;
    LightBounds bounds(const Lamp& lamp, const Curves* curves, float radiance) const;

    const SceneData& data_;
    const Shading& shading_;
    const bool apart_;
    std::vector<Source> sources_;
    std::vector<std::uint32_t> source_of_;  // by lamp
    std::vector<Facet> facets_;             // of meshes that are one lamp
    std::vector<float> ends_;               // by facet: share of its lamp's area up to and with it
    std::vector<Facet> wholes_;             // parallelograms of two triangles, which can be chosen from at once
    LampBalls balls_;
    std::vector<EvenLamp> known_;                   // by lamp, or nothing
    std::vector<std::uint32_t> sources_of_shapes_;  // none: does not shine
};

}  // namespace lightnet
