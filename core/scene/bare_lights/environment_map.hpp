// Pictures of light from infinity, weighed so that their bright parts can be found.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/environment_data.hpp"
#include "core/scene/bare_lights/sky_cells.hpp"
#include "core/scene/textures/image.hpp"

namespace lightnet {

/// An image as a map of directions: looked up bilinearly, and weighed cell by cell (a cell is a pixel) by the luminance
/// by which the cell is brighter than the map on average. What is darker is left to directions from the BSDF, which
/// find it as well: sampling both alike would waste one. Karlík et al. 2019, "MIS Compensation". Knows nothing of what
/// turns it, or of how bright it is made: all lights that have the image share one. Immutable; any thread may ask.
// DECISIONS: bright-sky
// DECISIONS: maps-weighed-once
class EnvironmentMap {
public:
    using Layout = EnvironmentData::Layout;
    /// Of an image that has pixels.
    EnvironmentMap(std::shared_ptr<const Image> image, Layout layout);

    Layout layout() const { return layout_; }
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }

    /// Four pixels, by the upper left one, and the place between their middles.
    struct Spot {
        std::int32_t x, y;
        float dx, dy;
    };
    /// The image's colours there.
    Rgb colour(const Spot& spot) const {
        const auto [x, y, dx, dy] = spot;
        const bool inside = x >= 0 && y >= 0 && std::uint32_t(x) + 1 < width_ && std::uint32_t(y) + 1 < height_;
        if (!inside || !numbers_) return at_the_rim(spot);
        const float* upper = numbers_ + 3 * (std::size_t(y) * width_ + std::size_t(x));
        const float* lower = upper + 3 * std::size_t{width_};
        const auto at = [](const float* numbers) { return Rgb{numbers[0], numbers[1], numbers[2]}; };
        return Image::Square{at(upper), at(upper + 3), at(lower), at(lower + 3)}.bilinear(dx, dy);
    }
    /// Fetches memory of both rows of pixels that lie around.
    void expect(std::int64_t x, std::int64_t y) const {
        const auto column = std::uint32_t(std::max<std::int64_t>(0, x)),
                   row = std::uint32_t(std::max<std::int64_t>(0, y));
        const std::uint32_t below = std::min(row + 1, height_ - 1);
        if (!numbers_) {
            image_->expect(column, row);
            image_->expect(column, below);
            return;
        }
        __builtin_prefetch(numbers_ + 3 * (std::size_t{row} * width_ + column));
        __builtin_prefetch(numbers_ + 3 * (std::size_t{below} * width_ + column));
    }

    /// Chosen by their weights, the rows first, then the cells of a row.
    const SkyCells& cells() const { return cells_; }
    /// Of a cell with all light of its row, sr⁻¹.
    float density(std::uint32_t row) const { return density_[row]; }
    /// By edge of a row of longitudes, from the nearer pole: 1 - cos of the angle.
    Vec2 drops(std::uint32_t row) const {
        const std::uint32_t from_pole = 2 * row >= height_ ? height_ - 1 - row : row;
        return {drops_[from_pole], drops_[from_pole + 1]};
    }
    /// ∫ colour dω over all directions.
    Rgb total() const { return total_; }
    /// Of all light: what cells are weighed by.
    float bright_share() const { return bright_share_; }
    /// Bytes, without the image.
    std::size_t memory() const { return cells_.memory(); }

private:
    double row_solid_angle(std::uint32_t y) const;
    Rgb pixel(std::int64_t x, std::int64_t y) const;
    Rgb at_the_rim(const Spot& spot) const;
    void weigh();
    void list_rows();

    std::shared_ptr<const Image> image_;
    Layout layout_;
    std::uint32_t width_, height_;
    const float* numbers_ = nullptr;  // the image's, where these are all usable, and three a pixel
    SkyCells cells_;
    std::vector<float> density_, drops_;
    Rgb total_;
    float bright_share_ = 0;
};

/// Of that image; the one that others have, where they have one: an edit of a light does not weigh its image again. Any
/// thread.
std::shared_ptr<const EnvironmentMap> environment_map(const std::shared_ptr<const Image>& image,
                                                      EnvironmentData::Layout layout);

}  // namespace lightnet
