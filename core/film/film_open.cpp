// The last group of a film, where a picture of more samples would add to it, and groups of which blocks are missing.
#include <algorithm>
#include <functional>

#include "core/film/film.hpp"

namespace lightnet {

// It lacks blocks that it has in a picture of more samples, or its last block is short.
// DECISIONS: last-group-apart
bool Film::is_open(const Blocks& group) const {
    const std::uint32_t of_any_picture = format_.adaptive() ? 1 : lightnet::group_of(group.first).count;
    return group.first + of_any_picture > format_.samples / samples_per_block;
}

void Film::end_if_open_group_is_there(Rectangle& rectangle, const Tile& tile) {
    if (rectangle.done || rectangle.next_block == blocks_) return;
    const Blocks group = group_of(rectangle.next_block);
    if (!is_open(group)) return;
    for (std::uint32_t i = 0; i < group.count; ++i)
        if (!rectangle.has(group.first + i)) return;
    rectangle.done = true;
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) block_of_[index(x, y)] = blocks_;
    folded_ += tile.pixels() * group.count;
}

// Those that have come one behind the other, whether their group is whole or not.
std::uint32_t Film::blocks_shown(const Rectangle& rectangle) {
    std::uint32_t blocks = rectangle.next_block;
    for (const auto& [block, sum] : rectangle.waiting) {
        if (block != blocks) break;
        blocks += sum.blocks;
    }
    return blocks;
}

std::uint32_t Film::samples_shown(const Rectangle& rectangle) const {
    return std::min(blocks_shown(rectangle) * samples_per_block, format_.samples);
}

// Of the blocks that are shown and that are not in the sums of the film, in their order: what a picture that ends with
// them has for its last group. Empty: there is none.
std::vector<Rgb> Film::sum_of_begun_group(const Rectangle& rectangle) const {
    std::vector<Rgb> sum;
    const std::uint32_t end = blocks_shown(rectangle);
    for (const auto& [block, part] : rectangle.waiting) {
        if (block >= end) break;
        auto pixels = part.pixels;
        std::replace_if(pixels.begin(), pixels.end(), std::not_fn(finite), Rgb{});
        if (sum.empty())
            sum = std::move(pixels);
        else
            addition_(sum, pixels);
    }
    return sum;
}

// To the sums of `among`, of which the rectangle's area is a part.
void Film::add_begun_group(const Rectangle& rectangle, const Tile& area, const Tile& among, std::span<Rgb> sums) const {
    const std::size_t row = area.width * format_.colours();
    const auto group = sum_of_begun_group(rectangle);
    for (std::uint32_t y = 0; !group.empty() && y < area.height; ++y) {
        const std::size_t to = std::size_t{area.y - among.y + y} * among.width + area.x - among.x;
        addition_(sums.subspan(to * format_.colours(), row), std::span(group).subspan(y * row, row));
    }
}

Film::Shown Film::shown() const {
    const Tile whole{window_.x, window_.y, window_.width, window_.height};
    Shown all{sums_, std::vector<std::uint32_t>(window_.pixels()), {}};
    for (const auto& [place, rectangle] : rectangles_) {
        const auto& [x, y, width, height] = place;
        for (std::uint32_t row = y; row < y + height; ++row)
            std::fill_n(all.samples.begin() + std::ptrdiff_t(index(x, row)), width, samples_shown(rectangle));
        if (blocks_shown(rectangle) == rectangle.next_block) continue;
        if (all.own.empty()) all.sums = all.own = sums_;
        add_begun_group(rectangle, {x, y, width, height}, whole, all.own);
    }
    return all;
}

// The same of a tile alone.
Film::Shown Film::shown_of(const Tile& tile) const {
    const std::size_t colours = format_.colours();
    Shown all{{}, std::vector<std::uint32_t>(tile.pixels()), std::vector<Rgb>(tile.pixels() * colours)};
    for (std::uint32_t y = 0; y < tile.height; ++y)
        std::copy_n(sums_.begin() + std::ptrdiff_t(index(tile.x, tile.y + y) * colours), tile.width * colours,
                    all.own.begin() + std::ptrdiff_t(y * tile.width * colours));
    for (const Tile& area : format_.adaptive() ? cells_of(tile) : std::vector<Tile>{tile}) {
        const auto known = rectangles_.find({area.x, area.y, area.width, area.height});
        if (known == rectangles_.end()) continue;
        for (std::uint32_t y = 0; y < area.height; ++y) {
            const std::size_t to = std::size_t{area.y - tile.y + y} * tile.width + area.x - tile.x;
            std::fill_n(all.samples.begin() + std::ptrdiff_t(to), area.width, samples_shown(known->second));
        }
        add_begun_group(known->second, area, tile, all.own);
    }
    all.sums = all.own;
    return all;
}

// `pixel`: sums of all colours.
Rgb Film::seen_as(std::size_t view, std::span<const Rgb> pixel, float samples) const {
    if (samples == 0) return {};
    const auto& name = format_.name_of(view);
    if (format_.ids.contains(name)) return false_colour(pixel.subspan(view, format_.width_of(name)), samples);
    const Rgb mean = pixel[view] / samples;
    if (!format_.is_plain(view)) return {mean.r, mean.r, mean.r};
    return mean * (format_.is_light(view) ? scale_ : 1);
}

std::vector<Rgb> Film::so_far(const Tile& tile) const {
    const std::size_t colours = format_.colours();
    const Shown shown = shown_of(tile);
    const auto views = format_.views();
    std::vector<Rgb> seen;
    seen.reserve(tile.pixels() * views.size());
    for (std::size_t i = 0; i < tile.pixels(); ++i)
        for (const std::size_t k : views)
            seen.push_back(seen_as(k, shown.sums.subspan(i * colours, colours), static_cast<float>(shown.samples[i])));
    return seen;
}

std::vector<Tile> Film::areas() const {
    std::vector<Tile> areas;
    for (const auto& [area, rectangle] : rectangles_) {
        const auto& [x, y, width, height] = area;
        areas.push_back({x, y, width, height});
    }
    return areas;
}

std::vector<std::uint64_t> Film::lost() const {
    auto lost = lost_;
    for (const auto& [area, rectangle] : rectangles_) {
        const std::uint32_t end = blocks_shown(rectangle);
        for (const auto& [block, part] : rectangle.waiting)
            for (std::size_t i = 0; block < end && i < part.pixels.size(); ++i)
                lost[i % lost.size()] += !finite(part.pixels[i]);
    }
    return lost;
}

}  // namespace lightnet
