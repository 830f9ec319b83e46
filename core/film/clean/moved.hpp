// Sums over cells of a few pixels of what cleaning moves from place to place.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/film/clean/sheet.hpp"
#include "core/film/picture.hpp"

namespace lightnet::cleaning {

/// Pixels along a side of a cell.
inline constexpr std::int64_t cell_side = 4;

/// Cells along one side of a picture or of a part of it. A crop has them where its whole picture does. A value.
class CellAxis {
public:
    CellAxis() = default;
    /// Of `pixels` from `first` on; `crop`: where the picture begins in its whole one.
    CellAxis(std::int64_t first, std::uint32_t pixels, std::int64_t crop)
        : crop_(crop),
          left_((first + crop) / cell_side),
          cells_(static_cast<std::size_t>((first + pixels - 1 + crop) / cell_side - left_ + 1)) {}

    std::size_t cells() const { return cells_; }
    std::size_t cell_of(std::int64_t pixel) const {
        return static_cast<std::size_t>((pixel + crop_) / cell_side - left_);
    }
    std::int64_t first_pixel_of(std::size_t cell) const {
        return (left_ + static_cast<std::int64_t>(cell)) * cell_side - crop_;
    }
    /// Where the first cell of a part lies among these.
    std::size_t place_of(const CellAxis& part) const { return static_cast<std::size_t>(part.left_ - left_); }

    /// Two cells, between whose middles a pixel's middle lies, and how far on the way.
    struct Between {
        std::size_t lower, upper;
        float way;
    };
    Between between(std::int64_t pixel) const;

private:
    std::int64_t crop_ = 0, left_ = 0;
    std::size_t cells_ = 0;
};

/// Cores of areas along one side. Each cell lies in one of them, so that a crop adds up its pixels as the whole does.
class CoreAxis {
public:
    CoreAxis(std::uint32_t pixels, std::int64_t crop) : pixels_(pixels), shift_(crop % cell_side) {}
    std::size_t cores() const {
        return static_cast<std::size_t>((pixels_ + shift_ + std::int64_t{core_side} - 1) / std::int64_t{core_side});
    }
    std::int64_t first(std::size_t core) const {
        return std::max<std::int64_t>(0, static_cast<std::int64_t>(core * core_side) - shift_);
    }
    /// Of the core that begins at `first`.
    std::uint32_t pixels_from(std::int64_t first) const {
        const std::int64_t side = core_side, end = ((first + shift_) / side + 1) * side - shift_;
        return static_cast<std::uint32_t>(std::min(end, pixels_) - first);
    }

private:
    static_assert(core_side % cell_side == 0);
    std::int64_t pixels_, shift_;
};

/// Both sides of cells.
struct CellGrid {
    CellAxis columns, rows;
    std::size_t size() const { return columns.cells() * rows.cells(); }
    std::size_t cell_of(std::int64_t x, std::int64_t y) const {
        return rows.cell_of(y) * columns.cells() + columns.cell_of(x);
    }
};

/// One number per cell, row by row.
using CellPlane = std::vector<float>;

/// What cleaning does to the cells of a picture, or of a part of it: sums over their pixels, without gains. A value.
struct Moved {
    CellGrid grid;
    std::vector<CellPlane> planes;  // in the order of the numbers below

    static constexpr std::size_t brightness = 0, apart = 1, change = 4, lost = 10;
    static constexpr std::size_t apart_of(std::size_t channel) { return apart + channel; }
    static constexpr std::size_t change_of(std::size_t half, std::size_t channel) {
        return change + 3 * half + channel;
    }
    static constexpr std::size_t lost_of(std::size_t layer, std::size_t channel) { return lost + 3 * layer + channel; }

    Moved() = default;
    Moved(const Picture& picture, Place place, std::uint32_t width, std::uint32_t height, std::size_t layers)
        : grid{{place.x, width, picture.x}, {place.y, height, picture.y}},
          planes(lost + 3 * layers, CellPlane(grid.size())) {}

    /// Adds a row of the part's pixels, whose numbers are value(0), value(1), … from `left` on.
    template <class Value>
    void add_row(std::size_t plane, Place left, std::int64_t width, const Value& value) {
        float* const row = planes[plane].data() + grid.rows.cell_of(left.y) * grid.columns.cells();
        std::int64_t x = 0;
        for (std::size_t cell = 0; cell < grid.columns.cells(); ++cell) {
            const std::int64_t end = std::min(width, grid.columns.first_pixel_of(cell + 1) - left.x);
            float sum = 0;
            for (; x < end; ++x) sum += value(x);
            row[cell] += sum;
        }
    }
    /// Adds a part of the picture, some cells of which may have pixels in other parts, too.
    void add(const Moved& part);
};

/// A pixel's own part in the brightness of its cell: what is darker than this counts as bright as that. Errors are seen
/// in parts of about as much.
inline constexpr float dim = 0.1f;

/// What would be darker than black is black.
inline float lit(float value, float change) {
    const float sum = value + change;
    return value >= 0 && sum < 0 ? 0 : sum;
}

}  // namespace lightnet::cleaning
