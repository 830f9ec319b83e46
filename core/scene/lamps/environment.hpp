// Light from infinity.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/math/frame.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// One environment. Immutable; any thread may ask. A map is looked up bilinearly, and sampled cell by cell (a cell is a
/// pixel) in proportion to the luminance that it holds on average, uniformly by solid angle within the cell.
class Environment {
public:
    explicit Environment(const EnvironmentData& data);

    /// Radiance from `direction` (unit, away from the eye), W·sr⁻¹·m⁻².
    Rgb radiance(Vec3 direction) const;

    /// Without a map it is the same everywhere, and sampled uniformly.
    bool has_map() const { return image_ != nullptr; }
    /// A direction by importance: by the CDF of the rows, then by that of its row's columns.
    Vec3 sample(Vec2 u) const;
    /// Density with which sample() finds `direction`, per steradian.
    float pdf(Vec3 direction) const;

    /// Irradiance of its mean over all directions, were it all to arrive head-on: ∫ radiance dω, W·m⁻².
    Rgb total() const { return total_; }
    /// Bytes, without the image.
    std::size_t memory() const { return (columns_.size() + rows_.size()) * sizeof(float); }

private:
    Rgb pixel(std::int64_t x, std::int64_t y) const;
    void weigh();
    double row_solid_angle(std::uint32_t y) const;
    Vec2 to_square(Vec3 direction) const;

    Rgb scale_;
    std::shared_ptr<const Image> image_;
    EnvironmentData::Layout layout_;
    Frame axes_;  // its own, in world space
    std::uint32_t width_ = 0, height_ = 0;
    std::vector<float> rows_;     // share of the light up to and with each row
    std::vector<float> columns_;  // by row: share of the row's light up to and with each column
    Rgb total_;
};

}  // namespace lightnet
