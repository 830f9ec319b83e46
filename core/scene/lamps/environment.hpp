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
#include "core/scene/data/scene_data.hpp"
#include "core/scene/shapes/ray.hpp"
#include "core/scene/surfaces/light_sample.hpp"

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
    std::size_t memory() const { return (columns_.size() + rows_.size() + marks_.size()) * sizeof(float); }

private:
    /// A cell, and the place within it: (0, 0) is its upper left corner.
    struct Cell {
        std::size_t x = 0, y = 0;
        Vec2 within;
    };
    Rgb pixel(std::int64_t x, std::int64_t y) const;
    void weigh();
    void mark_all();
    double row_solid_angle(std::uint32_t y) const;
    Vec2 to_square(Vec3 direction) const;
    Rgb radiance_at(Vec2 square) const;
    /// Fetches the pixels around.
    void expect(Vec2 square) const;
    float pdf_of(std::size_t x, std::size_t y) const;
    SkyRadiance seen_in(const Cell& cell) const;
    std::span<const float> columns_of(std::size_t y) const { return std::span(columns_).subspan(y * width_, width_); }
    std::span<const std::uint32_t> marks_of(std::size_t y) const {
        return std::span(marks_).subspan(y * marks_per_row_, marks_per_row_);
    }
    void find_row(float u, Cell& cell) const;
    void find_column(float u, Cell& cell) const;

    std::optional<Portal> portal_;
    Rgb scale_;
    std::shared_ptr<const Image> image_;
    EnvironmentData::Layout layout_;
    Frame axes_;  // its own, in world space
    std::uint32_t width_ = 0, height_ = 0;
    std::vector<float> rows_;                       // share of the light up to and with each row
    std::vector<float> columns_;                    // by row: share of the row's light up to and with each column
    std::vector<std::uint32_t> row_marks_, marks_;  // where to look in rows_; in columns_, by row: see mark()
    std::size_t marks_per_row_ = 0;
    std::vector<float> density_;  // by row: sr⁻¹ in a cell that has all light
    std::vector<float> drops_;    // by edge of a row of longitudes, from the upper pole: 1 - cos of the angle
    bool all_usable_ = true;      // each number of the picture
    Rgb total_;
    float bright_share_ = 0;  // of all light: what sample() goes by
};

}  // namespace lightnet
