#include "core/scene/media/bounds.hpp"

namespace lightnet {

CollisionBounds::CollisionBounds(const VolumeField& extinction) : to_grid_(extinction.to_grid) {
    for (std::size_t axis = 0; axis < 3; ++axis) size_[axis] = std::min(extinction.grid->size[axis], most_cells);
    std::array<std::uint32_t, 3> cell;
    for (cell[2] = 0; cell[2] < size_[2]; ++cell[2])
        for (cell[1] = 0; cell[1] < size_[1]; ++cell[1])
            for (cell[0] = 0; cell[0] < size_[0]; ++cell[0]) most_.push_back(most_in(cell, extinction));
}

// Of all points between which a place in the cell may lie.
float CollisionBounds::most_in(std::array<std::uint32_t, 3> cell, const VolumeField& extinction) const {
    const VolumeGrid& grid = *extinction.grid;
    std::array<std::int64_t, 3> first, last;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t points = grid.size[axis];
        first[axis] = cell[axis] * points / size_[axis] - 1;
        last[axis] = ((cell[axis] + 1) * points + size_[axis] - 1) / size_[axis];
    }
    float most = 0;
    for (std::int64_t z = first[2]; z <= last[2]; ++z)
        for (std::int64_t y = first[1]; y <= last[1]; ++y)
            for (std::int64_t x = first[0]; x <= last[0]; ++x)
                most = std::max(most, max_component(extinction.value * grid.point(x, y, z)));
    return most;
}

}  // namespace lightnet
