// A density over the unit square that has been learnt: where samples of directions go.
#pragma once

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

/// A density over the unit square, the same everywhere within each of some cells of equal size.
/// DECISIONS: guides-are-squares
class GuideSquare {
public:
    static constexpr std::size_t side = 16;  // cells along a side
    static constexpr std::size_t cells = side * side;

    /// Even.
    GuideSquare() : GuideSquare(std::vector<double>(cells, 1)) {}
    /// How much lies in each cell, column by column: all of them more than nothing.
    explicit GuideSquare(std::span<const double> parts) {
        double all = 0, before = 0;
        for (const double part : parts) all += part;
        for (std::size_t x = 0; x < side; ++x) {
            double column = 0, below = 0;
            for (std::size_t y = 0; y < side; ++y) column += parts[x * side + y];
            columns_[x] = float((before += column) / all);
            for (std::size_t y = 0; y < side; ++y) {
                rows_[x][y] = float((below += parts[x * side + y]) / column);
                density_[x][y] = float(parts[x * side + y] / all * cells);
            }
        }
    }

    static std::size_t cell_of(Vec2 place) {
        return std::size_t(place.x * float(side)) * side + std::size_t(place.y * float(side));
    }
    /// At a place of the square, whose coordinates are below 1.
    float density(Vec2 place) const {
        return density_[std::size_t(place.x * float(side))][std::size_t(place.y * float(side))];
    }
    /// Takes evenly distributed points to those of the density, well stratified ones to well stratified ones.
    SquarePoint warp(Vec2 u) const {
        const auto [x, across] = found(columns_, u.x);
        const auto [y, up] = found(rows_[x], u.y);
        return {{(float(x) + across) / float(side), (float(y) + up) / float(side)}, density_[x][y]};
    }

private:
    using Ends = std::array<float, side>;
    struct Found {
        std::size_t at;
        float part;
    };
    // Without a branch, as where it ends can't be foretold.
    static Found found(const Ends& ends, float u) {
        std::uint32_t at = 0;
        for (std::size_t i = 0; i + 1 < side; ++i) at += u >= ends[i];
        const float begin = at > 0 ? ends[at - 1] : 0;
        return {at, std::fmin((u - begin) / (ends[at] - begin), 0x1.ffffp-1f)};
    }

    Ends columns_;                 // running sums of columns
    std::array<Ends, side> rows_;  // in each column, of its cells
    std::array<Ends, side> density_;
};

/// The place of the unit square that disk() takes to this point of the unit disk.
inline Vec2 from_disk(Vec2 p) {
    const bool flat = std::fabs(p.x) > std::fabs(p.y);
    const float along = flat ? p.x : p.y, aside = flat ? p.y : p.x;
    const float radius = std::copysign(std::sqrt(p.x * p.x + p.y * p.y), along);
    // arctangent of 0 … 1, as Cephes has it: a few ulps, and the same on every libm
    const float t = along == 0 ? 0 : std::fabs(aside / along);
    const bool steep = t > 0.41421356f;
    const float x = steep ? (t - 1) / (t + 1) : t, z = x * x;
    const float small =
        (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z - 3.33329491539e-1f) * z * x + x;
    const float angle = steep ? pi / 4 + small : small;
    const float other = std::copysign(angle * (4 / pi), aside * along) * radius;
    const auto unit = [](float v) { return std::fmin(std::fmax(0.5f * v + 0.5f, 0.0f), below_one); };
    return flat ? Vec2{unit(radius), unit(other)} : Vec2{unit(other), unit(radius)};
}

}  // namespace lightnet
