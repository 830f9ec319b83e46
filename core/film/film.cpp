#include "core/film/film.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

FilmFormat sound(FilmFormat format) {
    expect_sound(format);
    return format;
}

// Of the pixels of a tile, those of one of its areas.
void cut(std::span<const Rgb> pixels, const Tile& tile, const Tile& area, std::size_t colours, std::vector<Rgb>& into) {
    into.clear();
    for (std::uint32_t row = area.y - tile.y; row < area.y - tile.y + area.height; ++row) {
        const auto first = pixels.begin() + std::ptrdiff_t((std::size_t{row} * tile.width + area.x - tile.x) * colours);
        into.insert(into.end(), first, first + std::ptrdiff_t(area.width * colours));
    }
}

// All pixels of a coarse look: each shows what the one that was looked at does, beside it or above.
std::vector<Rgb> with_neighbours(const Tile& tile, std::span<const Rgb> told, std::size_t colours) {
    std::vector<Rgb> all;
    all.reserve(tile.pixels() * colours);
    for (std::size_t y = 0; y < tile.height; ++y)
        for (std::size_t x = 0; x < tile.width; ++x) {
            const auto from = told.subspan((y / tile.stride * tile.columns() + x / tile.stride) * colours, colours);
            all.insert(all.end(), from.begin(), from.end());
        }
    return all;
}

// Neighbours go together: fewer tiles for the same work.
std::vector<Tile> joined(const std::vector<Tile>& cells) {
    std::vector<Tile> rows, tiles;
    for (const Tile& cell : cells)
        if (!rows.empty() && rows.back().y == cell.y && rows.back().first_sample == cell.first_sample &&
            rows.back().x + rows.back().width == cell.x)
            rows.back().width += cell.width;
        else
            rows.push_back(cell);
    for (const Tile& row : rows) {
        const auto above = std::find_if(tiles.begin(), tiles.end(), [&](const Tile& other) {
            return other.x == row.x && other.width == row.width && other.y + other.height == row.y &&
                   other.first_sample == row.first_sample;
        });
        if (above == tiles.end())
            tiles.push_back(row);
        else
            above->height += row.height;
    }
    return tiles;
}

}  // namespace

Film::Film(FilmFormat format)
    : format_(sound(std::move(format))),
      tiling_(format_),
      sums_(format_, tiling_),
      parts_(tiling_),
      round_(round_beyond(0, format_)),
      all_(std::uint64_t{tiling_.blocks()} * tiling_.window().pixels()) {}

bool Film::add(const Tile& tile, std::span<const Rgb> pixels) {
    tiling_.expect_valid(tile, pixels.size());
    if (tile.coarse) return add_area(tile, with_neighbours(tile, pixels, format_.colours()));
    if (!format_.adaptive()) return add_area(tile, pixels);
    bool added = false;
    std::vector<Rgb> piece;
    for (const Tile& cell : tiling_.areas_of(tile)) {
        cut(pixels, tile, cell, format_.colours(), piece);
        added = add_area(cell, piece) || added;
    }
    return added;
}

bool Film::add_area(const Tile& tile, std::span<const Rgb> pixels) {
    auto& part = parts_.claim(area_of(tile), tiling_);
    if (parts_.has(tile)) return false;
    if (tile.blocks() > 1 && !std::all_of(pixels.begin(), pixels.end(), finite)) return false;
    if (tile.block() == part.next_block && tiling_.is_whole(tile) && !tiling_.is_open(tiling_.group_of(tile.block())))
        fold_next(part, tile, pixels);
    else
        keep(part, tile, pixels);
    auto& waiting = part.waiting;
    while (!waiting.empty() && waiting.begin()->first == part.next_block &&
           tiling_.comes_next(part.next_block, waiting.begin()->second.blocks))
        fold_next(part, tile, waiting.extract(waiting.begin()).mapped().pixels);
    end_if_open_group_is_there(part, area_of(tile));
    return true;
}

// The group after those that are in the sums.
void Film::fold_next(FilmPart& part, const Tile& tile, std::span<const Rgb> pixels) {
    if (part.done) return;
    const Blocks group = tiling_.group_of(part.next_block);
    sums_.fold(tile, group.count, pixels, scale_);
    folded_ += tile.pixels() * group.count;
    part.next_block += group.count;
    part.waiting.erase(part.waiting.begin(), part.waiting.lower_bound(part.next_block));
    end_if_enough(part, area_of(tile));
}

// Until its turn comes. Blocks of a group are added up as soon as those before them are there.
void Film::keep(FilmPart& part, const Tile& tile, std::span<const Rgb> pixels) {
    auto& waiting = part.waiting;
    const Blocks together = tiling_.handed_out(tile.block());
    const std::uint32_t end = together.first + together.count;
    const bool whole = tiling_.is_whole(tile);
    if (whole) waiting.erase(waiting.lower_bound(together.first), waiting.lower_bound(end));
    auto& kept = waiting[tile.block()] = {tile.blocks(), {pixels.begin(), pixels.end()}};
    if (whole) return;
    sums_.blacken(kept.pixels);
    const auto sum = waiting.find(together.first);
    if (sum == waiting.end()) return;
    auto& [blocks, colours] = sum->second;
    for (auto next = std::next(sum);
         next != waiting.end() && next->first == together.first + blocks && next->first < end;
         next = waiting.erase(next)) {
        sums_.addition()(colours, next->second.pixels);
        blocks += next->second.blocks;
    }
}

void Film::end_if_enough(FilmPart& part, const Window& area) {
    const bool may_end = sums_.has_spreads() && part.next_block >= blocks_in(format_.least_samples());
    const auto enough = [&] {
        return sums_.noise_of(area) <= double(format_.refinement.noise) * double(area.pixels());
    };
    if (part.next_block == tiling_.blocks() || part.ended || (may_end && enough())) {
        part.done = true;
        spared_ += area.pixels() * (tiling_.blocks() - part.next_block);
    }
}

void Film::end_if_open_group_is_there(FilmPart& part, const Window& area) {
    if (part.done || part.next_block == tiling_.blocks()) return;
    const Blocks group = tiling_.group_of(part.next_block);
    if (!tiling_.is_open(group)) return;
    for (std::uint32_t i = 0; i < group.count; ++i)
        if (!part.has(group.first + i)) return;
    part.done = true;
    sums_.count(area, tiling_.blocks());
    folded_ += area.pixels() * group.count;
}

// The block that a cell goes on with, beyond those that every pixel gets and that are handed out anyhow.
std::optional<Tile> Film::next_of(const Tile& place) const {
    const auto* part = parts_.find(area_of(place));
    if (!part || part->done) return std::nullopt;
    if (part->next_block < blocks_in(format_.least_samples()) || part->next_block >= round_) return std::nullopt;
    return tiling_.block_of(area_of(place), part->next_block);
}

std::vector<Tile> Film::going_on() const {
    std::vector<Tile> wanted;
    if (!format_.adaptive()) return wanted;
    for (const auto& [area, part] : parts_)
        if (const auto next = next_of({area.x, area.y, area.width, area.height})) wanted.push_back(*next);
    return wanted;
}

std::vector<Tile> Film::more(const Tile& tile) const {
    if (tile.blocks() > 1 && !has(tile)) return one_by_one(tile);
    if (!format_.adaptive()) return {};
    std::vector<Tile> cells;
    for (const Tile& place : tiling_.areas_of(tile))
        // A block that is not above this one was asked for when its turn came.
        if (const auto next = next_of(place); next && next->block() > tile.block()) cells.push_back(*next);
    return joined(cells);
}

bool Film::has(const Tile& tile) const {
    const auto areas = tiling_.areas_of(tile);
    return std::all_of(areas.begin(), areas.end(), [this](const Tile& area) { return parts_.has(area); });
}

std::vector<Tile> Film::lacking(const Tile& tile) const {
    if (has(tile)) return {};
    auto blocks = one_by_one(tile);
    const auto there = std::erase_if(blocks, [this](const Tile& block) { return has(block); });
    return there == 0 ? std::vector<Tile>{tile} : blocks;
}

double Film::done() const {
    std::uint64_t there = folded_ + spared_;
    if (!format_.adaptive() && !complete()) {
        there = 0;
        for (const auto& [area, part] : parts_) there += std::uint64_t{area.pixels()} * part.blocks_shown();
    }
    return static_cast<double>(there) / static_cast<double>(all_);
}

double Film::mean_samples() const {
    double sum = 0;
    for (const auto& [area, part] : parts_) sum += double(area.pixels()) * tiling_.samples_in(part.blocks_shown());
    const double taken = format_.coarse ? 1.0 / (coarse_stride * coarse_stride) : 1;
    return taken * sum / static_cast<double>(tiling_.window().pixels());
}

std::optional<std::uint32_t> Film::even_samples() const {
    const auto blocks = parts_.even_blocks();
    return blocks ? std::optional(tiling_.samples_in(*blocks)) : std::nullopt;
}

double Film::covered() const {
    std::uint64_t pixels = 0;
    for (const auto& [area, part] : parts_)
        if (part.blocks_shown() > 0) pixels += area.pixels();
    return static_cast<double>(pixels) / static_cast<double>(tiling_.window().pixels());
}

std::uint32_t Film::samples_begun() const {
    std::uint32_t blocks = 0;
    for (const auto& [area, part] : parts_) blocks = std::max(blocks, part.blocks_begun());
    return tiling_.samples_in(blocks);
}

std::vector<Tile> Film::areas() const {
    std::vector<Tile> areas;
    for (const auto& [area, part] : parts_) areas.push_back({area.x, area.y, area.width, area.height});
    return areas;
}

std::vector<std::uint64_t> Film::lost() const {
    auto lost = sums_.lost();
    for (const auto& [area, part] : parts_) {
        const std::uint32_t end = part.blocks_shown();
        for (const auto& [block, sum] : part.waiting)
            for (std::size_t i = 0; block < end && i < sum.pixels.size(); ++i)
                lost[i % lost.size()] += !finite(sum.pixels[i]);
    }
    return lost;
}

}  // namespace lightnet
