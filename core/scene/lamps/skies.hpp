// All environments of a scene, as one light.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/environment.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet {

/// A ball around all shapes of a scene.
struct BallAround {
    Vec3 center;
    float radius = 1;  // m
};

/// Environments add up. Those with a map or a portal are sampled, by the light that they have; constant ones never are:
/// directions from the BSDF are the better ones for them everywhere. Any thread may ask.
class Skies {
public:
    /// `group`: that of their light.
    Skies(const SceneData& data, std::uint32_t group);
    /// None.
    Skies() = default;

    std::size_t size() const { return environments_.size(); }
    /// There is one that is not black.
    bool shine() const { return shine_; }
    /// There is one that sample() finds.
    bool sampled() const { return !maps_.empty(); }
    /// There is a single map without a portal, so that many may be sampled at once.
    bool one_map() const { return maps_.size() == 1 && !has_portals_; }

    /// A direction to what is sampled. None: no light comes by this sample.
    std::optional<LightSample> sample(Vec3 from, float choice, Vec2 u) const;
    /// As sample(), of one_map().
    void sample(std::span<const Vec2> u, std::span<SkyRadiance> seen) const;
    LightSample sampled_as(const SkyRadiance& seen) const;
    /// Density with which sample() finds the ray's direction.
    float pdf(const Ray& ray) const;
    /// Radiance along a ray that meets nothing.
    Rgb radiance(const Ray& ray) const;
    /// Radiance and pdf() of up to `lanes` rays.
    void look(std::span<const Ray> rays, std::span<SkyRadiance> seen) const;

    /// All that one of them sends into a ball, W.
    Rgb power(std::size_t sky, const BallAround& around) const;
    /// Light of one of them, going into the ball.
    Emission emit(std::size_t sky, const BallAround& around, Vec2 position_sample, Vec2 direction_sample) const;
    std::size_t memory() const;

private:
    std::optional<LightSample> through_portals(Vec3 from, float choice, Vec2 u) const;
    float density_of(std::size_t map, const Ray& ray) const;

    std::vector<Environment> environments_;
    std::vector<std::uint32_t> maps_;  // into environments_: those that are sampled, as they have a map or a portal
    std::vector<float> map_ends_;      // share of the light of maps up to and with each
    Rgb constant_;                     // sum of environments without a map or a portal
    std::uint32_t group_ = 0;
    bool has_portals_ = false;
    bool shine_ = false;
};

/// The place of `choice` within a share of [0,1) that begins at `start`.
float within(float choice, float start, float share);

/// Light of one direction that goes into a ball: from a disk across the direction, before it. `irradiance`: W·m⁻².
Emission through_ball(const BallAround& around, Vec3 direction, Rgb irradiance, Vec2 position_sample);

}  // namespace lightnet
