// Densities over the unit square that are tabulated on a grid, a table for each of several settings, and how to sample
// them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/vec.hpp"

namespace lightnet {

/// Up to four tables and their shares, which sum up to 1: what lies between the settings that were tabulated.
struct TableBlend {
    std::array<std::uint32_t, 4> table{};
    std::array<float, 4> share{};
    std::uint32_t count = 0;
};

/// Nodes of a grid over the unit square, row by row, the corners among them.
struct GridSize {
    std::uint32_t wide = 0, high = 0;  // 2 at least

    std::size_t nodes() const { return std::size_t{wide} * high; }
};

/// The square of a grid in which a place lies, and where in it (both 0 … 1).
struct GridCell {
    std::uint32_t x = 0, y = 0;
    float right = 0, down = 0;
};
/// `place` within the unit square, or the nearest place of it.
GridCell cell_of(GridSize size, Vec2 place);

/// Bilinear within the squares of its grid, linear between its tables. Any thread may ask.
class SquareDensities {
public:
    /// A point of the square, and a density there: of `place` when sampled.
    struct Found {
        Vec2 place;
        float density = 0;
    };

    SquareDensities() = default;
    /// `tables`: as many numbers as the grid has nodes for each, none below 0. Each is scaled so that its integral is
    /// 1; one that is 0 everywhere is 1 everywhere.
    SquareDensities(GridSize size, std::vector<float> tables);

    float density(Vec2 place, const TableBlend& blend) const;
    /// Turns evenly distributed points into such as have this density: first y, then x within that row.
    Found sample(Vec2 u, const TableBlend& blend) const;
    /// The reverse of sample(): the point that it turns into `place`, and the density of `place`.
    Found invert(Vec2 place, const TableBlend& blend) const;

private:
    float mixed(const std::vector<float>& of, std::size_t per_table, std::size_t at, const TableBlend& blend) const;
    float row_total(std::uint32_t y, const TableBlend& blend) const;
    float value(std::uint32_t x, std::uint32_t y, float down, const TableBlend& blend) const;
    float until(std::uint32_t x, std::uint32_t y, float down, const TableBlend& blend) const;

    GridSize size_;
    std::vector<float> values_;
    std::vector<float> rows_;     // integral of a row from its start to each node
    std::vector<float> columns_;  // integral of all rows down to each
};

/// A number at a place, bilinear between those at the nodes of a grid.
float bilinear(std::span<const float> values, GridSize size, Vec2 place);

}  // namespace lightnet
