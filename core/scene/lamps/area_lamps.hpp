// Shapes that shine: points on them, and how likely each is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/lamp_groups.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/lamps/lamp_kinds.hpp"
#include "core/scene/lamps/lamp_radiance.hpp"
#include "core/scene/lamps/lamp_sources.hpp"
#include "core/scene/lamps/light_tree.hpp"
#include "core/scene/lamps/lit_point.hpp"
#include "core/scene/shapes/ray.hpp"
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

    std::size_t size() const { return sources_.size(); }
    /// A point on a lamp that is chosen for certain. None: it sends no light this way.
    std::optional<LightSample> sample(std::size_t lamp, const LitPoint& from, Vec2 u) const;
    /// Fetches what sample() will read of some lamps from memory.
    void expect(std::span<const LightChoice> chosen) const { sources_.expect(chosen); }
    /// The lamp for many points at once, if it can be looked at so.
    EvenLamp even(std::size_t lamp) const;
    /// What even() gives, kept. Null: there are too many.
    const EvenLamp* known(std::size_t lamp) const { return known_.empty() ? nullptr : &known_[lamp]; }
    /// Density with which sample() finds the emitting point `on`, which lies in `direction` from `from`.
    float pdf(std::size_t lamp, Vec3 from, Vec3 direction, const SurfacePoint& on) const;
    /// The lamp that a point of a surface belongs to.
    std::optional<std::size_t> lamp_at(const SurfacePoint& point) const { return sources_.lamp_at(point); }
    /// Of the shape that a lamp is: 0 where groups are one.
    std::uint32_t group_of(std::uint32_t shape) const { return apart_ ? data_.shapes[shape].emission->label.group : 0; }
    /// Radiance that a point of a surface emits into `direction` (unit, away from it).
    Rgb radiance(const SurfacePoint& point, Vec3 direction) const;
    /// Does the shape have lamps?
    bool shines(std::uint32_t shape) const { return sources_.shines(shape); }
    /// Could the ray meet a lamp? False is certain.
    bool may_meet(const Ray& ray) const { return sources_.balls().may_meet(ray); }

    LightBounds bounds(std::size_t lamp) const;
    /// All that the lamp emits, W; of a textured one, nearly.
    Rgb power(std::size_t lamp) const;
    /// Light leaving the lamp: uniform by area, by the cosine in direction; flux as if it were the only light.
    std::optional<Emission> emit(std::size_t lamp, Vec2 position_sample, Vec2 direction_sample, ShutterTime time) const;
    std::size_t memory() const;

private:
    Rgb mean_of_texture(const AreaLamp& lamp) const;

    const SceneData& data_;
    const bool apart_;
    LampSources sources_;
    LampRadiance radiance_;
    std::vector<EvenLamp> known_;  // by lamp, or nothing
};

}  // namespace lightnet
