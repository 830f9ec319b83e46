// A density over the unit square that has been learnt: where samples of directions go.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/sampling.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// The largest number below 1 that a float32 holds.
inline constexpr float below_one = 0x1.fffffep-1f;

/// A point of the square, and how many times denser than evenly distributed points those like it lie.
struct SquarePoint {
    Vec2 place;
    float density = 1;
};

/// A density over the unit square, the same everywhere within each of some cells of equal size. In whole numbers of
/// 16 bits: a guide has many squares, and what is asked of them stays in the cache.
/// DECISIONS: guides-are-squares
class GuideSquare {
public:
    static constexpr std::size_t side = 16;  // cells along a side
    static constexpr std::size_t cells = side * side;

    /// Even.
    GuideSquare() : GuideSquare(std::vector<double>(cells, 1)) {}
    /// How much lies in each cell, column by column: all of them more than nothing.
    explicit GuideSquare(std::span<const double> parts) {
        std::array<double, side> columns{};
        for (std::size_t x = 0; x < side; ++x) {
            const auto column = parts.subspan(x * side, side);
            for (const double part : column) columns[x] += part;
            rows_[x] = begins_of(column);
        }
        columns_ = begins_of(columns);
    }

    static std::size_t cell_of(Vec2 place) {
        return std::size_t(place.x * float(side)) * side + std::size_t(place.y * float(side));
    }
    /// At a place of the square, whose coordinates are below 1.
    float density(Vec2 place) const {
        return density(std::size_t(place.x * float(side)), std::size_t(place.y * float(side)));
    }
    /// Takes evenly distributed points to those of the density, well stratified ones to well stratified ones.
    SquarePoint warp(Vec2 u) const {
        const Part column = column_at(u.x);
        return warped(u, column, cell_at(column.index, u.y));
    }

    // What warp() is made of.

    /// One of some in a row, which share the numbers of [0, 1) by their sizes.
    struct Part {
        std::int32_t index, begin, width;  // the latter two where all of them are `whole`
    };
    /// To whom a number belongs: of the columns, and of the cells of one.
    Part column_at(float u) const { return part_at(columns_, u); }
    Part cell_at(std::int32_t column, float u) const { return part_at(rows_[std::size_t(column)], u); }
    /// What cell_at() reads, to be fetched ahead.
    const void* cells_of(std::int32_t column) const { return &rows_[std::size_t(column)]; }
    [[gnu::always_inline]] static SquarePoint warped(Vec2 u, Part column, Part cell) {
        return {{along(u.x, column), along(u.y, cell)}, float(column.width) * float(cell.width) * density_scale};
    }

private:
    static constexpr std::uint32_t whole = 65536;
    static constexpr float density_scale = float(cells) / (float(whole) * float(whole));
    using Begins = std::array<std::uint16_t, side>;  // of cells, where all of them together are `whole`
    // Each has something, so that no place of the square is never found.
    static Begins begins_of(std::span<const double> parts) {
        double all = 0, before = 0;
        for (const double part : parts) all += part;
        Begins begins{};
        for (std::size_t i = 1; i < side; ++i) {
            before += parts[i - 1];
            const std::uint32_t least = begins[i - 1] + 1u, most = whole - std::uint32_t(side - i);
            begins[i] = std::uint16_t(std::clamp(std::uint32_t(before / all * whole + 0.5), least, most));
        }
        return begins;
    }
    // Of the last one, too: 65536 is 0.
    static std::uint16_t width(const Begins& begins, std::size_t i) {
        return std::uint16_t(begins[(i + 1) % side] - begins[i]);
    }
    float density(std::size_t x, std::size_t y) const {
        return float(width(columns_, x)) * float(width(rows_[x], y)) * density_scale;
    }
    // Halves what is left four times, without a branch, as where it ends can't be foretold.
    static Part part_at(const Begins& begins, float u) {
        const auto below = std::uint16_t(std::int32_t(u * float(whole)));
        std::size_t i = 0;
        for (std::size_t half = side / 2; half > 0; half /= 2) i += std::size_t{begins[i + half] <= below} * half;
        return {std::int32_t(i), begins[i], width(begins, i)};
    }
    [[gnu::always_inline]] static float along(float u, const Part& part) {
        constexpr float most = 0x1.ffffp-1f;
        const float within = (u * float(whole) - float(part.begin)) / float(part.width);
        return (float(part.index) + (within < most ? within : most)) / float(side);
    }

    Begins columns_;
    std::array<Begins, side> rows_;  // of each column
};

/// The place of the unit square that disk() takes to this point of the unit disk.
inline Vec2 from_disk(Vec2 p) {
    const bool flat = std::fabs(p.x) > std::fabs(p.y);
    const float along = flat ? p.x : p.y, aside = flat ? p.y : p.x;
    const float radius = std::copysign(std::sqrt(p.x * p.x + p.y * p.y), along);
    // arctangent of 0 … 1, as Cephes has it: a few ulps, and the same on every libm
    const float t = std::fabs(aside / (along == 0 ? 1 : along));
    const bool steep = t > 0.41421356f;
    const float x = (steep ? t - 1 : t) / (steep ? t + 1 : 1), z = x * x;
    const float small =
        (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z - 3.33329491539e-1f) * z * x + x;
    const float angle = small + (steep ? pi / 4 : 0);
    const float other = std::copysign(angle * (4 / pi), aside * along) * radius;
    const auto unit = [](float v) {
        const float from_zero = 0.5f * v + 0.5f, least = from_zero > 0 ? from_zero : 0;
        return least < below_one ? least : below_one;
    };
    const float first = unit(radius), second = unit(other);
    return {flat ? first : second, flat ? second : first};
}

}  // namespace lightnet
