// Lambertian meshes without bumps, as most surfaces are, shaded many at once.
#pragma once

#include <array>
#include <cstdint>

#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/surfaces/flat_lamp.hpp"
#include "core/scene/surfaces/heuristic.hpp"
#include "core/scene/surfaces/mesh_points.hpp"

namespace lightnet {

/// Points of ideal diffuse reflectors: points, shadow rays to a lamp and the next directions of paths.
class LambertianSurfaces : public MeshPoints {
public:
    /// Adds the point of a hit on `shape`, seen from `outgoing`; there is room for it. `who`: the caller's.
    void add(std::uint32_t who, const ColumnShape& shape, const Hit& hit, Vec3 outgoing) {
        const std::size_t to = size();
        add_point(who, shape, hit, outgoing);
        albedo_.set(to, {shape.albedo.r, shape.albedo.g, shape.albedo.b});
    }
    /// Works out where the points are, and how they are turned: before anything of the following is asked.
    void find_points();

    static bool has_gloss(std::size_t) { return false; }
    Rgb albedo(std::size_t i) const { return {albedo_.x[i], albedo_.y[i], albedo_.z[i]}; }
    Bsdf bsdf(std::size_t i) const;

    /// As Bsdf has it: all of them.
    static CosineChoices cosine_choices(std::size_t) { return {0, 1}; }
    static bool goes_by_cosine(std::size_t) { return true; }

    /// What Bsdf::sample() gives for each.
    struct Steps {
        Columns3 incoming;
        Column pdf;  // 0: none
    };
    const Steps& sample();
    /// What was drawn last.
    const Steps& steps() const { return steps_; }

    /// What ray_to_lamp() gives for each, of the only lamp.
    const RaysToLamp& look_at(const FlatLamp& lamp, Heuristic heuristic);
    /// What look_at() gives without the weight that both techniques share by: the light is whole.
    const RaysToLamp& look_at_whole(const FlatLamp& lamp);
    /// What ray_to_lamp() gives for each, of lamps that were sampled for it.
    const RaysToLamp& look_at(const LightSamples& lamps, Heuristic heuristic);
    const RaysToLamp& look_at_whole(const LightSamples& lamps);

private:
    struct Sampling;
    template <bool whole, bool parallelogram>
    struct Looking;
    template <bool whole>
    struct LookingAtMany;
    template <bool whole>
    const RaysToLamp& look(const FlatLamp& lamp, Heuristic heuristic);

    Columns3 albedo_;
    Steps steps_;
};

}  // namespace lightnet
