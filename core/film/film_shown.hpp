// The sums that pixels of a film show, with the groups that are begun.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/film_parts.hpp"
#include "core/film/film_sums.hpp"
#include "core/film/film_tiling.hpp"
#include "core/film/window.hpp"

namespace lightnet {

/// Of some pixels, row by row: sums of colours, of so many samples.
struct FilmShown {
    std::span<const Rgb> sums;
    std::vector<std::uint32_t> samples;
    std::vector<Rgb> own;  // the sums, where they are not the film's
};

/// Of all that is rendered.
FilmShown shown_of(const FilmTiling& tiling, const FilmSums& sums, const FilmParts& parts, std::size_t colours);
/// Of a tile alone.
FilmShown shown_of(const Tile& tile, const FilmTiling& tiling, const FilmSums& sums, const FilmParts& parts,
                   std::size_t colours);

}  // namespace lightnet
