// Choosing points on lights.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/rgb.hpp"
#include "core/math/vec.hpp"
#include "core/scene/ray.hpp"
#include "core/scene/scene_data.hpp"
#include "core/scene/surface.hpp"

namespace lightnet {

/// A sampled direction towards a light.
struct LightSample {
    Vec3 position;   // of the emitting point
    Vec3 direction;  // unit, from the lit point
    Rgb radiance;    // arriving, if nothing is in between
    float pdf = 0;   // per steradian at the lit point, choice of the light included; > 0
};

/// All lamps of a scene. A lamp is chosen with a chance in proportion to its power; a point on a mesh is uniform by
/// area, on a sphere uniform within the cone that it fills. A constant environment is never chosen: directions from the
/// BSDF are the better ones for it everywhere.
class Lights {
public:
    Lights() = default;
    /// Looks at `shapes` while it lives.
    explicit Lights(const std::vector<Shape>& shapes);

    bool empty() const { return lamps_.empty(); }
    /// There is more than one to choose from.
    bool many() const { return lamps_.size() > 1; }
    /// None: no light can reach the point by this sample.
    std::optional<LightSample> sample(Vec3 from, float choice, Vec2 u) const;
    /// Density with which sample() finds the emitting point `on`, which lies in `direction` from `from`. 0: not a lamp.
    float pdf(Vec3 from, Vec3 direction, const SurfacePoint& on) const;
    /// Could the ray meet a lamp? False is certain.
    bool may_meet(const Ray& ray) const;

private:
    /// A triangle of a lamp.
    struct Facet {
        Vec3 corner, first_edge, second_edge, normal;
    };
    struct Lamp {
        const Shape* shape = nullptr;
        float chance = 0;           // to be chosen
        float area = 0;             // m²
        Vec3 center;                // of a ball around it
        float radius = 0;           // of that ball, m
        std::vector<Facet> facets;  // of a mesh
        std::vector<float> ends;    // share of the area up to and with each facet
    };
    std::optional<LightSample> on_mesh(const Lamp& lamp, Vec3 from, Vec2 u) const;
    std::optional<LightSample> on_sphere(const Lamp& lamp, Vec3 from, Vec2 u) const;

    std::vector<Lamp> lamps_;
    std::vector<float> ends_;             // share of the power up to and with each lamp
    std::vector<std::uint32_t> lamp_of_;  // by shape; no_lamp
    static constexpr std::uint32_t no_lamp = 0xffffffffu;
};

}  // namespace lightnet
