// The cells of a map of the sky, chosen in proportion to what they weigh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/columns.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// A cell, and the place within it: (0, 0) is its upper left corner.
struct SkyCell {
    std::uint32_t x = 0, y = 0;
    Vec2 within;
    float share = 0;  // of its row's light
};

/// Those of up to `lanes` samples.
struct SkyCellColumns {
    Flags x, y;
    Columns2 within;
    Column share;
};

/// A row is chosen by the CDF of the rows, then a cell by that of its row's cells: both keep good numbers good, which
/// alias tables don't. Marks lead to where a number lies in a CDF. Immutable once finished; any thread may ask.
// DECISIONS: memory-of-a-sky-ahead
class SkyCells {
public:
    SkyCells() = default;
    SkyCells(std::uint32_t width, std::uint32_t height);

    /// Weights of a row's cells; returns their sum. Each row once, then finish().
    double set_row(std::uint32_t y, std::span<const double> weights);
    /// Weights of rows as wholes.
    void finish(const std::vector<double>& rows);

    SkyCell find(Vec2 u) const;
    /// What find() gives for each of up to `lanes`, to the bit; they wait for memory together.
    void find(std::span<const Vec2> u, SkyCellColumns& cells) const;

    float share_of_row(std::size_t y) const { return rows_[y + 1] - rows_[y]; }
    float share_in_row(std::size_t x, std::size_t y) const {
        const float* cell = at(x, y);
        return cell[1] - cell[0];
    }
    /// Where share_in_row() reads from.
    const float* at(std::size_t x, std::size_t y) const { return &cells_[y * (width_ + 1) + x]; }
    /// Bytes.
    std::size_t memory() const { return (cells_.size() + rows_.size() + marks_.size()) * sizeof(float); }

private:
    struct Finding;

    std::size_t width_ = 0, marks_per_row_ = 0;
    // A CDF begins with 0, so that each cell lies between two neighbours.
    std::vector<float> rows_, cells_;               // of the rows; of each row's cells, one behind the other
    std::vector<std::uint32_t> row_marks_, marks_;  // where to look in rows_; in cells_, by row: see mark()
};

}  // namespace lightnet
