#include "core/scene/bare_lights/sky_cells.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "core/base/math/prefix_cdf.hpp"

namespace lightnet {
namespace {

// All marks of rows stay in the cache; of cells there is one for eight, which are less than a line of it.
constexpr std::size_t cells_per_mark = 8;

std::size_t marks_for(std::size_t parts) { return std::bit_ceil(std::max<std::size_t>(1, parts)) + 1; }

}  // namespace

SkyCells::SkyCells(std::uint32_t width, std::uint32_t height)
    : width_(width), marks_per_row_(marks_for(width / cells_per_mark)), rows_(height + std::size_t{1}) {
    cells_.resize((width_ + 1) * height);
    row_marks_.resize(marks_for(height));
    marks_.resize(marks_per_row_ * height);
}

double SkyCells::set_row(std::uint32_t y, std::span<const double> weights) {
    const auto ends = std::span(cells_).subspan(y * (width_ + 1) + 1, width_);
    const double total = prefix_cdf(weights, ends);
    mark(ends, std::span(marks_).subspan(y * marks_per_row_, marks_per_row_));
    return total;
}

void SkyCells::finish(const std::vector<double>& rows) {
    const auto ends = std::span(rows_).subspan(1);
    prefix_cdf(rows, ends);
    mark(ends, row_marks_);
}

SkyCell SkyCells::find(Vec2 u) const {
    SkyCell cell{.within = u};
    cell.y = std::uint32_t(pick(std::span(rows_).subspan(1), row_marks_, cell.within.y));
    const auto ends = std::span(cells_).subspan(cell.y * (width_ + 1) + 1, width_);
    const auto marks = std::span(marks_).subspan(cell.y * marks_per_row_, marks_per_row_);
    cell.x = std::uint32_t(pick(ends, marks, cell.within.x));
    cell.share = share_in_row(cell.x, cell.y);
    return cell;
}

/// As pick(), for many numbers step by step: what one waits for, others needn't. Steps are as many as the longest way
/// has; who is there already stays.
struct SkyCells::Finding {
    std::size_t count;
    std::array<const float*, lanes> starts;  // where the CDF begins, with its 0
    Column u;
    Flags at, left;

    void begin(std::size_t i, const float* cdf, float number, const std::uint32_t* marks) {
        starts[i] = cdf;
        u[i] = number;
        at[i] = marks[0];
        left[i] = marks[1] - marks[0];
    }
    void find() {
        std::uint32_t most = 0;
        for (std::size_t i = 0; i < count; ++i) most = std::max(most, left[i]);
        for (; most > 0; most /= 2)
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint32_t half = (left[i] + 1) / 2;
                const auto passed = std::uint32_t(starts[i][at[i] + half] <= u[i]);
                at[i] += half & (0 - passed);  // which can't be foretold, and so is no branch
                left[i] /= 2;
            }
    }
    /// Where `u` lies in what was found, and the share of that.
    float within(std::size_t i, float& share) const {
        const float start = starts[i][at[i]];
        share = starts[i][at[i] + 1] - start;
        return std::clamp((u[i] - start) / share, 0.0f, 0x1.fffffep-1f);
    }
};

void SkyCells::find(std::span<const Vec2> u, SkyCellColumns& cells) const {
    Finding rows, columns;
    rows.count = columns.count = u.size();
    const auto pieces = float(row_marks_.size() - 1), pieces_of_row = float(marks_per_row_ - 1);
    for (std::size_t i = 0; i < u.size(); ++i)
        rows.begin(i, rows_.data(), u[i].y, &row_marks_[std::uint32_t(u[i].y * pieces)]);
    rows.find();
    std::array<const std::uint32_t*, lanes> marks;
    for (std::size_t i = 0; i < u.size(); ++i) {
        marks[i] = &marks_[rows.at[i] * marks_per_row_ + std::uint32_t(u[i].x * pieces_of_row)];
        __builtin_prefetch(marks[i]);
    }
    for (std::size_t i = 0; i < u.size(); ++i) {
        float share_of_row;
        cells.within.y[i] = rows.within(i, share_of_row);
    }
    cells.y = rows.at;
    for (std::size_t i = 0; i < u.size(); ++i) {
        columns.begin(i, &cells_[cells.y[i] * (width_ + 1)], u[i].x, marks[i]);
        __builtin_prefetch(columns.starts[i] + columns.at[i] + columns.left[i] / 2);
    }
    columns.find();
    cells.x = columns.at;
    for (std::size_t i = 0; i < u.size(); ++i) cells.within.x[i] = columns.within(i, cells.share[i]);
}

}  // namespace lightnet
