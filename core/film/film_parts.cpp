#include "core/film/film_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {

bool FilmPart::has(std::uint32_t block) const {
    if (done || block < next_block) return true;
    const auto behind = waiting.upper_bound(block);
    return behind != waiting.begin() && block < std::prev(behind)->first + std::prev(behind)->second.blocks;
}

std::uint32_t FilmPart::blocks_shown() const {
    std::uint32_t blocks = next_block;
    for (const auto& [block, sum] : waiting) {
        if (block != blocks) break;
        blocks += sum.blocks;
    }
    return blocks;
}

std::uint32_t FilmPart::blocks_begun() const {
    if (waiting.empty()) return next_block;
    const auto& [block, sum] = *waiting.rbegin();
    return std::max(next_block, block + sum.blocks);
}

std::vector<Rgb> FilmPart::begun_group(const Addition& addition) const {
    std::vector<Rgb> all;
    const std::uint32_t end = blocks_shown();
    for (const auto& [block, sum] : waiting) {
        if (block >= end) break;
        auto pixels = sum.pixels;
        std::replace_if(pixels.begin(), pixels.end(), std::not_fn(finite), Rgb{});
        if (all.empty())
            all = std::move(pixels);
        else
            addition(all, pixels);
    }
    return all;
}

const FilmPart* FilmParts::find(const Window& area) const {
    const auto known = parts_.find(area);
    return known == parts_.end() ? nullptr : &known->second;
}

FilmPart& FilmParts::claim(const Window& area, const FilmTiling& tiling) {
    if (const auto known = parts_.find(area); known != parts_.end()) return known->second;
    // The first tiling that is seen is the only one.
    for (const bool claim : {false, true})
        for (std::uint32_t y = area.y; y < area.y + area.height; ++y)
            for (std::uint32_t x = area.x; x < area.x + area.width; ++x) {
                auto&& pixel = taken_[tiling.index(x, y)];
                if (!claim && pixel) throw Error("film", fmt::format("two tiles overlap at pixel {},{}", x, y));
                if (claim) pixel = true;
            }
    return parts_[area];
}

bool FilmParts::has(const Tile& tile) const {
    const auto* part = find(area_of(tile));
    if (!part) return false;
    for (std::uint32_t i = 0; i < tile.blocks(); ++i)
        if (!part->has(tile.block() + i)) return false;
    return true;
}

bool FilmParts::everywhere() const { return std::find(taken_.begin(), taken_.end(), false) == taken_.end(); }

std::optional<std::uint32_t> FilmParts::even_blocks() const {
    std::optional<std::uint32_t> blocks;
    for (const auto& [area, part] : parts_) {
        const std::uint32_t there = part.blocks_shown();
        if (there != part.blocks_begun() || blocks.value_or(there) != there) return std::nullopt;
        blocks = there;
    }
    return everywhere() && blocks > 0u ? blocks : std::nullopt;
}

}  // namespace lightnet
