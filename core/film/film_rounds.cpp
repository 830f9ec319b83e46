// Rounds of a film whose cells wait for each other.
#include <algorithm>
#include <utility>

#include "core/film/film.hpp"

namespace lightnet {

std::uint32_t round_beyond(std::uint32_t blocks, const FilmFormat& format) {
    const std::uint32_t all = blocks_in(format.samples);
    std::uint32_t goal = format.in_rounds() ? blocks_in(format.least_samples()) : all;
    while (goal <= blocks && goal < all) goal += std::max(1u, goal / 2);
    return std::min(goal, all);
}

bool Film::round_is_over() const {
    if (!format_.in_rounds() || complete()) return false;
    return parts_.everywhere() && std::all_of(parts_.begin(), parts_.end(), [this](const auto& place) {
               return place.second.done || place.second.next_block >= round_;
           });
}

std::vector<Tile> Film::end_round(std::span<const double> noise) {
    const Window seen = format_.crop.value_or(tiling_.window());
    for (auto& [area, part] : parts_) {
        if (part.done) continue;
        double sum = 0, pixels = 0;  // of those that the picture has
        for (std::uint32_t y = std::max(area.y, seen.y); y < std::min(area.y + area.height, seen.y + seen.height); ++y)
            for (std::uint32_t x = std::max(area.x, seen.x); x < std::min(area.x + area.width, seen.x + seen.width);
                 ++x) {
                sum += noise[std::size_t{y - seen.y} * seen.width + x - seen.x];
                ++pixels;
            }
        part.ended = sum <= double(format_.refinement.noise) * pixels;
        end_if_enough(part, area);
    }
    const std::uint32_t ended = std::exchange(round_, round_beyond(round_, format_));
    constexpr std::uint32_t at_once = 4 * cell_size;  // pixels along a side
    std::vector<Tile> wanted;
    for (Tile part : tiles_of(tiling_.window(), at_once, samples_per_block)) {
        part.first_sample = (ended - 1) * samples_per_block;
        for (const Tile& next : more(part)) wanted.push_back(next);
    }
    return wanted;
}

}  // namespace lightnet
