#include "core/scene/media/bounds.hpp"

namespace lightnet {

namespace {

constexpr std::size_t fine_points = std::size_t{1} << 22;

/// The most of each block of a grid.
std::vector<float> most_of_blocks(const VolumeField& extinction) {
    const VolumeGrid& grid = *extinction.grid;
    const std::size_t each = std::size_t{VolumeGrid::block_points} * grid.channels;
    std::vector<float> most;
    for (std::size_t first = 0; first < grid.values.size(); first += each) {
        float of_block = 0;
        for (std::size_t i = first; i < first + each; i += grid.channels) {
            const float* v = &grid.values[i];
            const Rgb value = grid.channels == 3 ? Rgb{v[0], v[1], v[2]} : Rgb{v[0], v[0], v[0]};
            of_block = std::max(of_block, max_component(extinction.value * value));
        }
        most.push_back(of_block);
    }
    return most;
}

}  // namespace

CollisionBounds::CollisionBounds(const VolumeField& extinction) : to_grid_(extinction.to_grid) {
    for (std::size_t axis = 0; axis < 3; ++axis) size_[axis] = std::min(extinction.grid->size[axis], most_cells);
    // where cells are wider than blocks, those are looked at instead of their points
    const bool coarse = !extinction.grid->blocks.empty() && extinction.grid->points() > fine_points;
    const std::vector<float> of_blocks = coarse ? most_of_blocks(extinction) : std::vector<float>();
    std::array<std::uint32_t, 3> cell;
    for (cell[2] = 0; cell[2] < size_[2]; ++cell[2])
        for (cell[1] = 0; cell[1] < size_[1]; ++cell[1])
            for (cell[0] = 0; cell[0] < size_[0]; ++cell[0]) most_.push_back(most_in(cell, extinction, of_blocks));
}

float CollisionBounds::most_at(Vec3 place) const {
    const Vec3 within = transform_point(to_grid_, place);
    std::array<std::int64_t, 3> cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(within[axis] >= 0 && within[axis] <= 1)) return 0;
        cell[axis] = std::min(std::int64_t(within[axis] * float(size_[axis])), size_[axis] - 1);
    }
    return most_[index(cell)];
}

// Of all points between which a place in the cell may lie.
float CollisionBounds::most_in(std::array<std::uint32_t, 3> cell, const VolumeField& extinction,
                               std::span<const float> of_blocks) const {
    const VolumeGrid& grid = *extinction.grid;
    std::array<std::int64_t, 3> first, last;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t points = grid.size[axis];
        first[axis] = cell[axis] * points / size_[axis] - 1;
        last[axis] = ((cell[axis] + 1) * points + size_[axis] - 1) / size_[axis];
    }
    float most = 0;
    const auto each = [&](std::int64_t step, auto&& value) {
        for (std::int64_t z = first[2]; z <= last[2]; z += step)
            for (std::int64_t y = first[1]; y <= last[1]; y += step)
                for (std::int64_t x = first[0]; x <= last[0]; x += step) most = std::max(most, value(x, y, z));
    };
    if (of_blocks.empty()) {
        each(1, [&](auto x, auto y, auto z) { return max_component(extinction.value * grid.point(x, y, z)); });
        return most;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = std::max<std::int64_t>(first[axis], 0) / VolumeGrid::block_side * VolumeGrid::block_side;
        last[axis] = std::min<std::int64_t>(last[axis], grid.size[axis] - 1);
    }
    each(VolumeGrid::block_side, [&](auto x, auto y, auto z) {
        return of_blocks[grid.block_of({std::uint32_t(x), std::uint32_t(y), std::uint32_t(z)})];
    });
    return most;
}

}  // namespace lightnet
