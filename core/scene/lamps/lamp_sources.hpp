// The shapes of a scene that shine, and the lamps that they are cut into.
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
#include "core/scene/data/scene_data.hpp"
#include "core/scene/lamps/lamp_balls.hpp"
#include "core/scene/lamps/light_tree.hpp"
#include "core/scene/surfaces/flat_lamp.hpp"
#include "core/scene/surfaces/shading.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

/// A shape that shines: one lamp, or as many as it has triangles.
struct LampSource {
    static constexpr std::uint32_t none = 0xffffffffu;

    std::uint32_t shape = 0;
    std::uint32_t first_lamp = 0;
    bool by_triangle = false;
    std::uint32_t first = 0, facets = 0;  // of a mesh that is one lamp: among the facets
    float area = 0;                       // m²; of what is one lamp
    Rgb radiance;
    bool two_sided = false;
    bool uniform = true;         // neither texture nor holes
    bool unseen = false;         // by any ray
    std::uint32_t whole = none;  // among the parallelograms
    std::uint32_t group = 0;
};

class LampSources;

/// One lamp. What is asked about many is not kept of each: a million of triangles have to fit.
struct AreaLamp {
    const LampSources& all;
    const LampSource& source;
    std::uint32_t triangle;  // which, where each is a lamp
    float area;              // m²
    ShutterTime time;
};

/// Any thread may ask.
class LampSources {
public:
    /// Those of some groups, which are told apart or are all one. Looks at data and shading while it lives.
    LampSources(const SceneData& data, const Shading& shading, GroupSet groups, bool apart);

    /// How many lamps there are.
    std::size_t size() const { return source_of_.size(); }
    AreaLamp lamp(std::size_t index, ShutterTime time) const;
    bool moves(const AreaLamp& lamp) const { return shading_.moving(lamp.source.shape) != nullptr; }
    /// with(lamp) at each step of its shape's motion; of one that stands still, once.
    template <class With>
    void at_each_step(std::size_t index, const With& with) const {
        const MovingShape* moving = shading_.moving(sources_[source_of_[index]].shape);
        const std::size_t steps = moving ? moving->steps() : 1;
        for (std::size_t step = 0; step < steps; ++step)
            with(lamp(index, steps > 1 ? ShutterTime(step * shutter_closes / (steps - 1)) : ShutterTime(0)));
    }
    /// Calls `use` with the shape that it is at its time.
    template <class Use>
    auto on_shape(const AreaLamp& lamp, const Use& use) const {
        if (const MovingShape* moving = shading_.moving(lamp.source.shape))
            return moving->placed(part_of_shutter(lamp.time), use);
        return std::visit(use, shading_.placed(lamp.source.shape));
    }

    /// The lamp that a point of a surface belongs to.
    std::optional<std::size_t> lamp_at(const SurfacePoint& point) const;
    /// Does the shape have lamps?
    bool shines(std::uint32_t shape) const { return of_shapes_[shape] != LampSource::none; }
    /// Around each shape that shines.
    const LampBalls& balls() const { return balls_; }

    /// Of a mesh: the facet that `u` chooses, of which it keeps what is left. `primitive`: which triangle it is.
    Facet facet_of(const AreaLamp& lamp, std::uint32_t& primitive, float& u) const;
    /// Of a mesh that is one lamp.
    std::span<const Facet> facets_of(const LampSource& source) const {
        return std::span(facets_).subspan(source.first, source.facets);
    }
    /// The parallelogram of two triangles, which can be chosen from at once. Null: it is none.
    const Facet* whole(const LampSource& source) const {
        return source.whole == LampSource::none ? nullptr : &wholes_[source.whole];
    }

    /// Fetches what will be read of some lamps from memory.
    void expect(std::span<const LightChoice> chosen) const;
    std::size_t memory() const;

private:
    struct Collecting;

    /// Of what is one lamp for each triangle.
    const Mesh& mesh_of(const LampSource& source) const {
        return *std::get<const Mesh*>(shading_.placed(source.shape));
    }

    const Shading& shading_;
    std::vector<LampSource> sources_;
    std::vector<std::uint32_t> source_of_;  // by lamp
    std::vector<Facet> facets_;             // of meshes that are one lamp
    std::vector<float> ends_;               // by facet: share of its lamp's area up to and with it
    std::vector<Facet> wholes_;
    LampBalls balls_;
    std::vector<std::uint32_t> of_shapes_;  // into sources_; none: does not shine
};

}  // namespace lightnet
