#include "core/film/film_shown.hpp"

#include <algorithm>

namespace lightnet {
namespace {

// To the sums of `among`, of which the part's area is some.
void add_begun_group(const FilmPart& part, const Window& area, const Window& among, const Addition& addition,
                     std::size_t colours, std::span<Rgb> sums) {
    const std::size_t row = area.width * colours;
    const auto group = part.begun_group(addition);
    for (std::uint32_t y = 0; !group.empty() && y < area.height; ++y) {
        const std::size_t to = std::size_t{area.y - among.y + y} * among.width + area.x - among.x;
        addition(sums.subspan(to * colours, row), std::span(group).subspan(y * row, row));
    }
}

void tell_samples(std::uint32_t samples, const Window& area, const Window& among, std::vector<std::uint32_t>& of) {
    for (std::uint32_t y = 0; y < area.height; ++y) {
        const std::size_t to = std::size_t{area.y - among.y + y} * among.width + area.x - among.x;
        std::fill_n(of.begin() + std::ptrdiff_t(to), area.width, samples);
    }
}

}  // namespace

FilmShown shown_of(const FilmTiling& tiling, const FilmSums& sums, const FilmParts& parts, std::size_t colours) {
    const Window& whole = tiling.window();
    FilmShown all{sums.all(), std::vector<std::uint32_t>(whole.pixels()), {}};
    for (const auto& [area, part] : parts) {
        tell_samples(tiling.samples_in(part.blocks_shown()), area, whole, all.samples);
        if (part.blocks_shown() == part.next_block) continue;
        if (all.own.empty()) all.own.assign(all.sums.begin(), all.sums.end());
        add_begun_group(part, area, whole, sums.addition(), colours, all.own);
    }
    if (!all.own.empty()) all.sums = all.own;
    return all;
}

FilmShown shown_of(const Tile& tile, const FilmTiling& tiling, const FilmSums& sums, const FilmParts& parts,
                   std::size_t colours) {
    FilmShown all{{}, std::vector<std::uint32_t>(tile.pixels()), std::vector<Rgb>(tile.pixels() * colours)};
    for (std::uint32_t y = 0; y < tile.height; ++y) {
        const auto row = sums.all().subspan(tiling.index(tile.x, tile.y + y) * colours, tile.width * colours);
        std::copy(row.begin(), row.end(), all.own.begin() + std::ptrdiff_t(y * row.size()));
    }
    for (const Tile& piece : tiling.areas_of(tile)) {
        const Window area = area_of(piece);
        const auto* part = parts.find(area);
        if (!part) continue;
        tell_samples(tiling.samples_in(part->blocks_shown()), area, area_of(tile), all.samples);
        add_begun_group(*part, area, area_of(tile), sums.addition(), colours, all.own);
    }
    all.sums = all.own;
    return all;
}

}  // namespace lightnet
