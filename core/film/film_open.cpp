// The last group of a film, where a picture of more samples would add to it.
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

bool Film::ends_open(const Rectangle& rectangle) const {
    return rectangle.done && rectangle.next_block < blocks_ && is_open(group_of(rectangle.next_block)) &&
           rectangle.waiting.contains(rectangle.next_block);
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

// In the order of its blocks, like any other group.
std::vector<Rgb> Film::sum_of_open_group(const Rectangle& rectangle) const {
    std::vector<Rgb> sum;
    for (const auto& [block, part] : rectangle.waiting) {
        auto pixels = part.pixels;
        std::replace_if(pixels.begin(), pixels.end(), std::not_fn(finite), Rgb{});
        if (sum.empty())
            sum = std::move(pixels);
        else
            addition_(sum, pixels);
    }
    return sum;
}

std::vector<Rgb> Film::sums_with_open_groups() const {
    std::vector<Rgb> sums = sums_;
    const std::size_t layers = format_.colours();
    for (const auto& [area, rectangle] : rectangles_) {
        if (!ends_open(rectangle)) continue;
        const auto& [left, top, width, height] = area;
        const auto group = sum_of_open_group(rectangle);
        for (std::uint32_t y = 0; y < height; ++y)
            addition_(std::span(sums).subspan(index(left, top + y) * layers, width * layers),
                      std::span(group).subspan(y * width * layers, width * layers));
    }
    return sums;
}

// To the sums of `among`, of which `area` is a part.
void Film::add_open_group(const Tile& area, const Tile& among, std::span<Rgb> sums) const {
    const auto known = rectangles_.find({area.x, area.y, area.width, area.height});
    if (known == rectangles_.end() || !ends_open(known->second)) return;
    const std::size_t row = area.width * format_.colours();
    const auto group = sum_of_open_group(known->second);
    for (std::uint32_t y = 0; y < area.height; ++y) {
        const std::size_t to = std::size_t{area.y - among.y + y} * among.width + area.x - among.x;
        addition_(sums.subspan(to * format_.colours(), row), std::span(group).subspan(y * row, row));
    }
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
    std::vector<Rgb> pixels(tile.pixels() * colours);
    for (std::uint32_t y = 0; y < tile.height; ++y)
        std::copy_n(sums_.begin() + std::ptrdiff_t(index(tile.x, tile.y + y) * colours), tile.width * colours,
                    pixels.begin() + std::ptrdiff_t(y * tile.width * colours));
    const auto areas = format_.adaptive() ? cells_of(tile) : std::vector<Tile>{tile};
    for (const Tile& area : areas) add_open_group(area, tile, pixels);
    const auto views = format_.views();
    std::vector<Rgb> seen;
    seen.reserve(tile.pixels() * views.size());
    for (std::size_t i = 0; i < tile.pixels(); ++i) {
        const auto x = std::uint32_t(i % tile.width), y = std::uint32_t(i / tile.width);
        const auto samples = static_cast<float>(samples_at(index(tile.x + x, tile.y + y)));
        for (const std::size_t k : views)
            seen.push_back(seen_as(k, std::span(pixels).subspan(i * colours, colours), samples));
    }
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
        if (!ends_open(rectangle)) continue;
        for (const auto& [block, part] : rectangle.waiting)
            for (std::size_t i = 0; i < part.pixels.size(); ++i) lost[i % lost.size()] += !finite(part.pixels[i]);
    }
    return lost;
}

}  // namespace lightnet
