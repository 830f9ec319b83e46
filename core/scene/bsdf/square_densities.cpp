#include "core/scene/bsdf/square_densities.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightnet {
namespace {

float lerp(float a, float b, float t) { return a + (b - a) * t; }

/// The integral from 0 to t of a density that goes from a to b.
float integral_to(float a, float b, float t) { return t * (a + 0.5f * (b - a) * t); }

/// The reverse: where that integral is `sum`.
float where_integral_is(float sum, float a, float b) {
    const float root = a + std::sqrt(std::max(0.0f, a * a + 2 * sum * (b - a)));
    return root > 0 ? std::clamp(2 * sum / root, 0.0f, 1.0f) : 0;
}

/// The last of `count` cells that begins at or before `sum`; `start` gives where each does.
template <class Start>
std::uint32_t cell_at(std::uint32_t count, float sum, const Start& start) {
    std::uint32_t low = 0, high = count - 1;
    while (low < high) {
        const std::uint32_t middle = (low + high + 1) / 2;
        if (start(middle) <= sum)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

}  // namespace

GridCell cell_of(GridSize size, Vec2 place) {
    const auto along = [](float at, std::uint32_t nodes) {
        const float scaled = std::clamp(at, 0.0f, 1.0f) * float(nodes - 1);
        const auto cell = std::min(static_cast<std::uint32_t>(scaled), nodes - 2);
        return std::pair(cell, scaled - float(cell));
    };
    const auto [x, right] = along(place.x, size.wide);
    const auto [y, down] = along(place.y, size.high);
    return {x, y, right, down};
}

float bilinear(std::span<const float> values, GridSize size, Vec2 place) {
    const auto [x, y, right, down] = cell_of(size, place);
    const float* upper = &values[std::size_t{y} * size.wide + x];
    const float* lower = upper + size.wide;
    return lerp(lerp(upper[0], upper[1], right), lerp(lower[0], lower[1], right), down);
}

SquareDensities::SquareDensities(GridSize size, std::vector<float> tables) : size_(size), values_(std::move(tables)) {
    const std::size_t count = values_.size() / size.nodes();
    rows_.resize(values_.size());
    columns_.resize(count * size.high);
    const double dx = 1.0 / (size.wide - 1), dy = 1.0 / (size.high - 1);
    for (std::size_t table = 0; table < count; ++table) {
        float* values = &values_[table * size.nodes()];
        float* rows = &rows_[table * size.nodes()];
        float* columns = &columns_[table * size.high];
        double whole = 0;
        std::vector<double> totals(size.high);
        for (std::uint32_t y = 0; y < size.high; ++y) {
            const float* row = values + std::size_t{y} * size.wide;
            for (std::uint32_t x = 1; x < size.wide; ++x) totals[y] += (double{row[x - 1]} + double{row[x]}) * 0.5 * dx;
            if (y > 0) whole += (totals[y - 1] + totals[y]) * 0.5 * dy;
        }
        const bool dark = !(whole > 0);
        for (std::size_t i = 0; i < size.nodes(); ++i) values[i] = dark ? 1 : float(double{values[i]} / whole);
        double above = 0, before = 0;
        for (std::uint32_t y = 0; y < size.high; ++y) {
            const float* row = values + std::size_t{y} * size.wide;
            double sum = 0;
            for (std::uint32_t x = 1; x < size.wide; ++x) {
                sum += (double{row[x - 1]} + double{row[x]}) * 0.5 * dx;
                rows[std::size_t{y} * size.wide + x] = float(sum);
            }
            if (y > 0) above += (before + sum) * 0.5 * dy;
            columns[y] = float(above);
            before = sum;
        }
    }
}

float SquareDensities::mixed(const std::vector<float>& of, std::size_t per_table, std::size_t at,
                             const TableBlend& blend) const {
    float sum = 0;
    for (std::uint32_t i = 0; i < blend.count; ++i) sum += blend.share[i] * of[blend.table[i] * per_table + at];
    return sum;
}

float SquareDensities::row_total(std::uint32_t y, const TableBlend& blend) const {
    return mixed(rows_, size_.nodes(), std::size_t{y + 1} * size_.wide - 1, blend);
}

/// At a node's column, between two rows.
float SquareDensities::value(std::uint32_t x, std::uint32_t y, float down, const TableBlend& blend) const {
    const std::size_t at = std::size_t{y} * size_.wide + x;
    return lerp(mixed(values_, size_.nodes(), at, blend), mixed(values_, size_.nodes(), at + size_.wide, blend), down);
}

float SquareDensities::until(std::uint32_t x, std::uint32_t y, float down, const TableBlend& blend) const {
    const std::size_t at = std::size_t{y} * size_.wide + x;
    return lerp(mixed(rows_, size_.nodes(), at, blend), mixed(rows_, size_.nodes(), at + size_.wide, blend), down);
}

float SquareDensities::density(Vec2 place, const TableBlend& blend) const {
    const auto [x, y, right, down] = cell_of(size_, place);
    return lerp(value(x, y, down, blend), value(x + 1, y, down, blend), right);
}

SquareDensities::Found SquareDensities::sample(Vec2 u, const TableBlend& blend) const {
    const auto above = [&](std::uint32_t y) { return mixed(columns_, size_.high, y, blend); };
    const std::uint32_t y = cell_at(size_.high - 1, u.y, above);
    const float upper = row_total(y, blend), lower = row_total(y + 1, blend);
    const float down = where_integral_is((u.y - above(y)) * float(size_.high - 1), upper, lower);

    const float wanted = u.x * lerp(upper, lower, down);
    const auto before = [&](std::uint32_t x) { return until(x, y, down, blend); };
    const std::uint32_t x = cell_at(size_.wide - 1, wanted, before);
    const float left = value(x, y, down, blend), right = value(x + 1, y, down, blend);
    const float along = where_integral_is((wanted - before(x)) * float(size_.wide - 1), left, right);
    return {{(float(x) + along) / float(size_.wide - 1), (float(y) + down) / float(size_.high - 1)},
            lerp(left, right, along)};
}

SquareDensities::Found SquareDensities::invert(Vec2 place, const TableBlend& blend) const {
    const auto [x, y, right, down] = cell_of(size_, place);
    const float upper = row_total(y, blend), lower = row_total(y + 1, blend);
    const float left_value = value(x, y, down, blend), right_value = value(x + 1, y, down, blend);
    const float in_row = until(x, y, down, blend) + integral_to(left_value, right_value, right) / float(size_.wide - 1);
    const float total = lerp(upper, lower, down);
    const float above = mixed(columns_, size_.high, y, blend) + integral_to(upper, lower, down) / float(size_.high - 1);
    return {{total > 0 ? std::min(in_row / total, 1.0f) : 0, std::min(above, 1.0f)},
            lerp(left_value, right_value, right)};
}

}  // namespace lightnet
