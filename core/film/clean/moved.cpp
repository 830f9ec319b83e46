#include "core/film/clean/moved.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet::cleaning {

CellAxis::Between CellAxis::between(std::int64_t pixel) const {
    const float place = (static_cast<float>((pixel + crop_) % cell_side) + 0.5f) / float{cell_side} - 0.5f;
    const std::size_t cell = cell_of(pixel), last = cells_ - 1;
    if (place < 0) return {cell ? cell - 1 : 0, cell, 1 + place};
    return {cell, std::min(cell + 1, last), place};
}

void Moved::add(const Moved& part) {
    const std::size_t left = grid.columns.place_of(part.grid.columns), top = grid.rows.place_of(part.grid.rows),
                      across = part.grid.columns.cells();
    for (std::size_t p = 0; p < part.planes.size(); ++p)
        for (std::size_t y = 0; y < part.grid.rows.cells(); ++y) {
            const float* const from = part.planes[p].data() + y * across;
            float* const to = planes[p].data() + (y + top) * grid.columns.cells() + left;
            for (std::size_t x = 0; x < across; ++x) to[x] += from[x];
        }
}

}  // namespace lightnet::cleaning
