// Light from infinity.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/frame.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/environment_data.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/bare_lights/sky_cells.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet {

/// One environment. Immutable; any thread may ask. A map is looked up bilinearly, and sampled cell by cell (a cell is a
/// pixel), uniformly by solid angle within the cell: in proportion to the luminance by which the cell is brighter than
/// the map on average. What is darker is left to directions from the BSDF, which find it as well: sampling both alike
/// would waste one. Karlík et al. 2019, "MIS Compensation".
// DECISIONS: bright-sky
class Environment {
public:
    explicit Environment(const EnvironmentData& data);

    /// Radiance from `direction` (unit, away from the eye), W·sr⁻¹·m⁻², where it shows().
    Rgb radiance(Vec3 direction) const;

    /// Is it seen along the ray, if nothing is in the way?
    bool shows(const Ray& ray) const { return !portal_ || portal_->passes(ray.origin, ray.direction); }
    const std::optional<Portal>& portal() const { return portal_; }

    /// Without a map it is the same everywhere, and sampled uniformly.
    bool has_map() const { return image_ != nullptr; }
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
    std::size_t memory() const { return cells_.memory(); }

private:
    using Layout = EnvironmentData::Layout;
    /// Four pixels, by the upper left one, and the place between their middles.
    struct Spot;
    template <Layout layout>
    struct Placing;
    struct Places;
    struct Looking;
    struct Seeing;
    Rgb pixel(std::int64_t x, std::int64_t y) const;
    void weigh();
    void list_rows();
    double row_solid_angle(std::uint32_t y) const;
    template <class Use>
    auto placed(const Use& use) const;
    Rgb radiance_at(const Spot& spot) const;
    Rgb at_the_rim(const Spot& spot) const;
    void expect(std::int64_t x, std::int64_t y) const;
    float pdf_at(Vec2 square) const;
    Vec2 drops_of(std::uint32_t y) const;

    std::optional<Portal> portal_;
    Rgb scale_;
    std::shared_ptr<const Image> image_;
    const float* numbers_ = nullptr;  // the image's, where these are all usable, and three a pixel
    EnvironmentData::Layout layout_;
    Frame axes_;  // its own, in world space
    std::uint32_t width_ = 0, height_ = 0;
    SkyCells cells_;
    std::vector<float> density_;  // by row: sr⁻¹ in a cell that has all light of its row
    std::vector<float> drops_;    // by edge of a row of longitudes, from the upper pole: 1 - cos of the angle
    Rgb total_;
    float bright_share_ = 0;  // of all light: what sample() goes by
};

/// Of that data; the one that another scene has, where it has one: what a map weighs is worked out once. Any thread.
std::shared_ptr<const Environment> environment_of(const EnvironmentData& data);

}  // namespace lightnet
