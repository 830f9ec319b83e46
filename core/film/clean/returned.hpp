// The return of light that cleaning moved too far.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/film/clean/moved.hpp"
#include "core/film/picture.hpp"

namespace lightnet::cleaning {

/// So often what cells have lost is smoothed with their neighbours, step by step: light that was moved far is returned
/// first.
inline constexpr std::array<std::int64_t, 5> smoothings{4, 2, 2, 1, 1};
/// Cells to each side of one, over which it is seen how much of its loss is no noise.
inline constexpr std::int64_t seen_to_each_side = 4;
/// So many pixels away light may be that changes what is returned here.
inline constexpr std::int64_t return_reach = [] {
    std::int64_t cells = 2;  // of which a pixel lies between, and of which it is part
    for (const auto times : smoothings) cells += times + seen_to_each_side;
    return cells * cell_side;
}();

/// Gives cells back what they have lost to others and what is no noise, as far as both halves of the samples tell: of
/// the squared change of a place, what it has in common with the noise is the part that was good. `brightness`: of each
/// pixel; by it a cell's light is shared out among pixels. The shares are the same for all layers and come from their
/// sum without gains: sums stay sums, and mixing commutes with it. What would be darker than black is black. The same
/// bytes on any number of threads.
void return_light(Moved moved, const std::vector<float>& brightness, Picture& picture);

}  // namespace lightnet::cleaning
