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
            std::transform(sum.begin(), sum.end(), pixels.begin(), sum.begin(), std::plus<>());
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
            for (std::size_t i = 0; i < width * layers; ++i)
                sums[index(left, top + y) * layers + i] += group[y * width * layers + i];
    }
    return sums;
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
