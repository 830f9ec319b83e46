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
    std::uint64_t there = 0;
    for (const auto& [area, rectangle] : rectangles_) {
        if (!rectangle.done && rectangle.next_block < round_) return false;
        there += std::uint64_t{std::get<2>(area)} * std::get<3>(area);
    }
    return there == window_.pixels();
}

std::vector<Tile> Film::end_round(std::span<const double> noise) {
    const Window seen = format_.crop.value_or(window_);
    for (auto& [area, rectangle] : rectangles_) {
        if (rectangle.done) continue;
        const auto& [x, y, width, height] = area;
        double sum = 0, pixels = 0;  // of those that the picture has
        for (std::uint32_t row = std::max(y, seen.y); row < std::min(y + height, seen.y + seen.height); ++row)
            for (std::uint32_t column = std::max(x, seen.x); column < std::min(x + width, seen.x + seen.width);
                 ++column) {
                sum += noise[std::size_t{row - seen.y} * seen.width + column - seen.x];
                ++pixels;
            }
        rectangle.ended = sum <= double(format_.refinement.noise) * pixels;
        end_if_enough(rectangle, {x, y, width, height});
    }
    const std::uint32_t ended = std::exchange(round_, round_beyond(round_, format_));
    constexpr std::uint32_t at_once = 4 * cell_size;  // pixels along a side
    std::vector<Tile> wanted;
    for (Tile part : tiles_of(window_, at_once, samples_per_block)) {
        part.first_sample = (ended - 1) * samples_per_block;
        for (const Tile& next : more(part)) wanted.push_back(next);
    }
    return wanted;
}

}  // namespace lightnet
