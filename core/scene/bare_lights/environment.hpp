// Light from infinity.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "core/base/math/frame.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/environment_data.hpp"
#include "core/scene/bare_lights/environment_map.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet {

/// One environment: a map, or the same everywhere. Immutable; any thread may ask. A map is sampled cell by cell,
/// uniformly by solid angle within the cell: see EnvironmentMap.
class Environment {
public:
    explicit Environment(const EnvironmentData& data);

    /// Radiance from `direction` (unit, away from the eye), W·sr⁻¹·m⁻², where it shows().
    Rgb radiance(Vec3 direction) const;

    /// Is it seen along the ray, if nothing is in the way?
    bool shows(const Ray& ray) const { return !portal_ || portal_->passes(ray.origin, ray.direction); }
    const std::optional<Portal>& portal() const { return portal_; }

    /// Without a map it is the same everywhere, and sampled uniformly.
    bool has_map() const { return map_ != nullptr; }
    /// Density with which sample() finds `direction`, per steradian.
    float pdf(Vec3 direction) const;
    /// radiance() and pdf().
    SkyRadiance look(Vec3 direction) const;
    /// radiance() and pdf() of up to `lanes` directions, which wait for memory as those of sample() do.
    void look(std::span<const Vec3> directions, std::span<SkyRadiance> seen) const;
    /// Towards bright parts, by the CDF of the rows, then by that of its row's columns.
    SkyRadiance sample(Vec2 u) const;
    /// Up to `lanes` samples at once. The memory that they need is fetched at once, and they don't wait for it one
    /// after the other.
    // DECISIONS: memory-of-a-sky-ahead
    // DECISIONS: skies-not-learnt
    void sample(std::span<const Vec2> u, std::span<SkyRadiance> seen) const;
    /// Towards all that shines, for those who have no other way to find it. `pdf` is that of this way.
    SkyRadiance sample_all(Vec2 u) const;

    /// Irradiance of its mean over all directions, were it all to arrive head-on: ∫ radiance dω, W·m⁻².
    Rgb total() const { return total_; }
    /// Bytes, without the image.
    std::size_t memory() const { return map_ ? map_->memory() : 0; }

private:
    using Layout = EnvironmentData::Layout;
    template <Layout layout>
    struct Placing;
    struct Places;
    struct Looking;
    struct Seeing;
    template <class Use>
    auto placed(const Use& use) const;
    Rgb radiance_at(const EnvironmentMap::Spot& spot) const;
    float pdf_at(Vec2 square) const;

    std::optional<Portal> portal_;
    Rgb scale_;
    std::shared_ptr<const EnvironmentMap> map_;  // null: none
    Frame axes_;                                 // its own, in world space
    Rgb total_;
};

}  // namespace lightnet
