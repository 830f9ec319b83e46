// Upper bounds of collisions in an uneven medium: null collisions fill what is missing to them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/scene/media/medium.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet {

/// A coarse grid over the cube that an extinction's grid fills: most collisions per metre, of any colour, in each cell.
class CollisionBounds {
public:
    CollisionBounds() = default;
    explicit CollisionBounds(const VolumeField& extinction);

    /// take(begin, end, most) of each cell that a ray crosses between two distances (metres), in order, until it says
    /// false. Returns what it said last.
    template <class Take>
    bool each_cell(const Ray& ray, float begin, float end, Take&& take) const;

    /// How many there are along each axis.
    std::array<std::uint32_t, 3> cells() const {
        return {std::uint32_t(size_[0]), std::uint32_t(size_[1]), std::uint32_t(size_[2])};
    }
    /// In a cell, x running fastest.
    float most(std::size_t cell) const { return most_[cell]; }
    /// In the cell at a place; 0 outside of the cube.
    float most_at(Vec3 place) const;

private:
    static constexpr std::uint32_t most_cells = 32;  // along an axis

    float most_in(std::array<std::uint32_t, 3> cell, const VolumeField& extinction,
                  std::span<const float> of_blocks) const;
    std::size_t index(const std::array<std::int64_t, 3>& cell) const {
        return std::size_t((cell[2] * size_[1] + cell[1]) * size_[0] + cell[0]);
    }

    std::array<std::int64_t, 3> size_{};
    std::vector<float> most_;
    Matrix to_grid_;
};

template <class Take>
bool CollisionBounds::each_cell(const Ray& ray, float begin, float end, Take&& take) const {
    constexpr float never = std::numeric_limits<float>::infinity();
    const Vec3 origin = transform_point(to_grid_, ray.origin), along = transform_direction(to_grid_, ray.direction);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float o = origin[axis], d = along[axis];
        if (d == 0 && !(o >= 0 && o <= 1)) return true;
        if (d == 0) continue;
        begin = std::max(begin, ((d > 0 ? 0 : 1) - o) / d);
        end = std::min(end, ((d > 0 ? 1 : 0) - o) / d);
    }
    if (!(begin < end)) return true;
    std::array<std::int64_t, 3> cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float place = (origin[axis] + along[axis] * begin) * float(size_[axis]);
        cell[axis] = std::clamp(static_cast<std::int64_t>(std::floor(place)), std::int64_t{0}, size_[axis] - 1);
    }
    const auto leaves = [&](std::size_t axis) {
        const float d = along[axis];
        return d == 0 ? never : (float(cell[axis] + (d > 0)) / float(size_[axis]) - origin[axis]) / d;
    };
    while (true) {
        const std::array<float, 3> next{leaves(0), leaves(1), leaves(2)};
        const auto axis = static_cast<std::size_t>(std::min_element(next.begin(), next.end()) - next.begin());
        const float stop = std::min(next[axis], end);
        if (stop > begin && !take(begin, stop, most_[index(cell)])) return false;
        if (stop >= end) return true;
        begin = std::max(begin, stop);
        cell[axis] += along[axis] > 0 ? 1 : -1;
        if (cell[axis] < 0 || cell[axis] >= size_[axis]) return true;
    }
}

}  // namespace lightnet
