#include "core/film/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
Film::Film(FilmFormat format)
    : format_(std::move(format)),
      addition_(format_.addition()),
      window_(format_.work()),
      blocks_(blocks_in(format_.samples)) {
    const auto& layers = format_.layers;
    if (!format_.width || !format_.height) throw Error("film", "a picture needs at least one pixel");
    if (!format_.samples) throw Error("film", "a picture needs at least one sample per pixel");
    if (layers.empty()) throw Error("film", "a picture needs at least one layer");
    std::set<std::string> names(layers.begin(), layers.end());
    names.insert(format_.shown.begin(), format_.shown.end());
    if (names.size() != layers.size() + format_.shown.size()) throw Error("film", "two layers have the same name");
    for (const auto& [matte, count] : format_.ids)
        for (std::uint32_t level = 0; 2 * level < count; ++level)
            if (const auto name = fmt::format("{}{:02}", matte, level); !names.insert(name).second)
                throw Error("film", "a layer is called '" + name + "', as one of the matte '" + matte + "'");
    const auto lies_within = [](std::uint32_t from, std::uint32_t size, std::uint32_t side) {
        return size > 0 && from < side && size <= side - from;
    };
    if (const auto& crop = format_.crop)
        if (!lies_within(crop->x, crop->width, format_.width) || !lies_within(crop->y, crop->height, format_.height))
            throw Error("film", "the crop is not inside of the picture");
    all_ = std::uint64_t{blocks_} * window_.pixels();
    round_ = round_beyond(0, format_);
    lost_.resize(format_.colours());
    try {
        take_room(window_.pixels());
    } catch (const std::bad_alloc&) {
        const auto bytes = double(window_.pixels()) * double(format_.colours()) * sizeof(Rgb);
        throw Error("film",
                    fmt::format("{}x{} pixels of {} layers take {:.0f} MB, which is more than there is memory for",
                                window_.width, window_.height, format_.colours(), bytes / 1e6));
    }
}

void Film::take_room(std::size_t pixels) {
    if (format_.adaptive() && !format_.in_rounds()) spreads_.resize(pixels);
    sums_.resize(pixels * format_.colours());
    block_of_.resize(pixels);
    taken_.resize(pixels);
}

bool Film::add(const Tile& tile, std::span<const Rgb> pixels) {
    expect_valid(tile, pixels.size());
    if (!format_.adaptive()) return add_area(tile, pixels);
    bool added = false;
    std::vector<Rgb> piece;
    const std::size_t layers = format_.colours();
    for (const Tile& cell : cells_of(tile)) {
        piece.clear();
        for (std::uint32_t row = cell.y - tile.y; row < cell.y - tile.y + cell.height; ++row) {
            const auto first =
                pixels.begin() + std::ptrdiff_t((std::size_t{row} * tile.width + cell.x - tile.x) * layers);
            piece.insert(piece.end(), first, first + std::ptrdiff_t(cell.width * layers));
        }
        added = add_area(cell, piece) || added;
    }
    return added;
}

Blocks Film::group_of(std::uint32_t block) const {
    if (format_.adaptive()) return {block, 1};
    const Blocks group = lightnet::group_of(block);
    return {group.first, std::min(group.count, blocks_ - group.first)};
}

Blocks Film::handed_out(std::uint32_t block) const {
    return format_.adaptive() ? Blocks{block, 1} : lightnet::handed_out(block, format_.samples);
}

bool Film::is_whole(const Tile& tile) const {
    const Blocks together = handed_out(tile.block());
    return tile.block() == together.first && tile.blocks() == together.count;
}

bool Film::Rectangle::has(std::uint32_t block) const {
    if (done || block < next_block) return true;
    const auto behind = waiting.upper_bound(block);
    return behind != waiting.begin() && block < std::prev(behind)->first + std::prev(behind)->second.blocks;
}

bool Film::add_area(const Tile& tile, std::span<const Rgb> pixels) {
    auto& rectangle = rectangle_of(tile);
    if (has_area(tile)) return false;
    if (tile.blocks() > 1 && !std::all_of(pixels.begin(), pixels.end(), finite)) return false;
    if (is_whole(tile) && tile.block() == rectangle.next_block && !is_open(group_of(tile.block())))
        fold_next(rectangle, tile, pixels);
    else
        keep(rectangle, tile, pixels);
    auto& waiting = rectangle.waiting;
    const auto comes_next = [&](const auto& sum) {
        const Blocks group = group_of(sum.first);
        return sum.first == rectangle.next_block && sum.second.blocks == group.count && !is_open(group);
    };
    while (!waiting.empty() && comes_next(*waiting.begin()))
        fold_next(rectangle, tile, waiting.extract(waiting.begin()).mapped().pixels);
    end_if_open_group_is_there(rectangle, tile);
    return true;
}

// The group after those that are in the sums.
void Film::fold_next(Rectangle& rectangle, const Tile& tile, std::span<const Rgb> pixels) {
    if (rectangle.done) return;
    const Blocks group = group_of(rectangle.next_block);
    fold(tile, group.count, pixels);
    rectangle.next_block += group.count;
    rectangle.waiting.erase(rectangle.waiting.begin(), rectangle.waiting.lower_bound(rectangle.next_block));
    end_if_enough(rectangle, tile);
}

// Until its turn comes. Blocks of a group are added up as soon as those before them are there.
void Film::keep(Rectangle& rectangle, const Tile& tile, std::span<const Rgb> pixels) {
    auto& waiting = rectangle.waiting;
    const Blocks together = handed_out(tile.block());
    const std::uint32_t end = together.first + together.count;
    if (is_whole(tile)) waiting.erase(waiting.lower_bound(together.first), waiting.lower_bound(end));
    auto& kept = waiting[tile.block()] = {tile.blocks(), {pixels.begin(), pixels.end()}};
    if (is_whole(tile)) return;
    blacken(kept.pixels);
    const auto sum = waiting.find(together.first);
    if (sum == waiting.end()) return;
    auto& [blocks, colours] = sum->second;
    for (auto next = std::next(sum);
         next != waiting.end() && next->first == together.first + blocks && next->first < end;
         next = waiting.erase(next)) {
        addition_(colours, next->second.pixels);
        blocks += next->second.blocks;
    }
}

// What is not finite, and counts it.
// DECISIONS: not-finite-is-black
void Film::blacken(std::span<Rgb> pixels) {
    for (std::size_t i = 0; i < pixels.size(); ++i)
        if (!finite(pixels[i])) {
            pixels[i] = {};
            ++lost_[i % format_.colours()];
        }
}

void Film::end_if_enough(Rectangle& rectangle, const Tile& tile) {
    const bool may_end = !spreads_.empty() && rectangle.next_block >= blocks_in(format_.least_samples());
    if (rectangle.next_block == blocks_ || rectangle.ended || (may_end && enough(tile))) {
        rectangle.done = true;
        spared_ += tile.pixels() * (blocks_ - rectangle.next_block);
    }
}

std::vector<Tile> Film::cells_of(const Tile& tile) const {
    std::vector<Tile> cells;
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; y += cell_size)
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; x += cell_size) {
            Tile& cell = cells.emplace_back(tile);
            cell.x = x, cell.width = std::min(cell_size, tile.x + tile.width - x);
            cell.y = y, cell.height = std::min(cell_size, tile.y + tile.height - y);
        }
    return cells;
}

// The block that a cell goes on with, beyond those that every pixel gets and that are handed out anyhow.
std::optional<Tile> Film::next_of(const Tile& place) const {
    const auto known = rectangles_.find({place.x, place.y, place.width, place.height});
    if (known == rectangles_.end() || known->second.done) return std::nullopt;
    const std::uint32_t next = known->second.next_block;
    if (next < blocks_in(format_.least_samples()) || next >= round_) return std::nullopt;
    return Tile{
        place.x, place.y, place.width, place.height, next * samples_per_block, samples_of(next, format_.samples)};
}

std::vector<Tile> Film::going_on() const {
    std::vector<Tile> wanted;
    if (!format_.adaptive()) return wanted;
    for (const auto& [area, rectangle] : rectangles_) {
        const auto& [x, y, width, height] = area;
        if (const auto next = next_of({x, y, width, height})) wanted.push_back(*next);
    }
    return wanted;
}

std::vector<Tile> Film::more(const Tile& tile) const {
    if (tile.blocks() > 1 && !has(tile)) return one_by_one(tile);
    std::vector<Tile> wanted;
    if (!format_.adaptive()) return wanted;
    std::vector<Tile> rows;
    for (const Tile& place : cells_of(tile)) {
        const auto next = next_of(place);
        // A block that is not above this one was asked for when its turn came.
        if (!next || next->block() <= tile.block()) continue;
        const Tile& cell = *next;
        // Neighbours of a row go together: fewer tiles for the same work.
        if (!rows.empty() && rows.back().y == cell.y && rows.back().first_sample == cell.first_sample &&
            rows.back().x + rows.back().width == cell.x)
            rows.back().width += cell.width;
        else
            rows.push_back(cell);
    }
    for (const Tile& run : rows) {
        const auto above = std::find_if(wanted.begin(), wanted.end(), [&](const Tile& other) {
            return other.x == run.x && other.width == run.width && other.y + other.height == run.y &&
                   other.first_sample == run.first_sample;
        });
        if (above == wanted.end())
            wanted.push_back(run);
        else
            above->height += run.height;
    }
    return wanted;
}

bool Film::has(const Tile& tile) const {
    if (!format_.adaptive()) return has_area(tile);
    const auto cells = cells_of(tile);
    return std::all_of(cells.begin(), cells.end(), [&](const Tile& cell) { return has_area(cell); });
}

bool Film::has_area(const Tile& tile) const {
    const auto known = rectangles_.find({tile.x, tile.y, tile.width, tile.height});
    if (known == rectangles_.end()) return false;
    for (std::uint32_t i = 0; i < tile.blocks(); ++i)
        if (!known->second.has(tile.block() + i)) return false;
    return true;
}

void Film::expect_valid(const Tile& tile, std::size_t colours) const {
    const auto within = [](std::uint32_t from, std::uint32_t size, std::uint32_t begin, std::uint32_t extent) {
        return size > 0 && from >= begin && from - begin < extent && size <= extent - (from - begin);
    };
    const auto of_cells = [&](std::uint32_t from, std::uint32_t size, std::uint32_t end) {
        return !format_.adaptive() || (from % cell_size == 0 && (size % cell_size == 0 || from + size == end));
    };
    const bool inside = within(tile.x, tile.width, window_.x, window_.width) &&
                        within(tile.y, tile.height, window_.y, window_.height) &&
                        of_cells(tile.x, tile.width, window_.x + window_.width) &&
                        of_cells(tile.y, tile.height, window_.y + window_.height);
    const bool of_look = (tile.coarse != 0) == format_.coarse;
    const bool of_blocks = tile.first_sample % samples_per_block == 0 && tile.first_sample < format_.samples &&
                           (tile.samples == samples_of(tile.block(), format_.samples) ||
                            (is_whole(tile) && tile.samples == samples_of(handed_out(tile.block()), format_.samples)));
    if (!inside || !of_blocks || !of_look)
        throw Error("film", fmt::format("no tile of this picture: {}x{} pixels at {},{}, {} samples from {}",
                                        tile.width, tile.height, tile.x, tile.y, tile.samples, tile.first_sample));
    if (colours != tile.pixels() * format_.colours())
        throw Error("film", fmt::format("a tile of {} pixels and {} layers came with {} colours", tile.pixels(),
                                        format_.colours(), colours));
}

Film::Rectangle& Film::rectangle_of(const Tile& tile) {
    const Area area{tile.x, tile.y, tile.width, tile.height};
    if (const auto known = rectangles_.find(area); known != rectangles_.end()) return known->second;
    // Tiles that overlap would add samples twice, so the first tiling that is seen is the only one.
    for (const bool claim : {false, true})
        for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
                auto&& pixel = taken_[index(x, y)];
                if (!claim && pixel) throw Error("film", fmt::format("two tiles overlap at pixel {},{}", x, y));
                if (claim) pixel = true;
            }
    return rectangles_[area];
}

void Film::fold(const Tile& tile, std::uint32_t blocks, std::span<const Rgb> pixels) {
    const std::size_t layers = format_.colours();
    const Rgb* next = pixels.data();
    std::vector<Rgb> sound(layers);
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
            const std::size_t pixel = index(x, y);
            for (std::size_t k = 0; k < layers; ++k, ++next) {
                sound[k] = finite(*next) ? *next : Rgb{};
                lost_[k] += !finite(*next);
            }
            addition_(std::span(sums_).subspan(pixel * layers, layers), sound);
            if (!spreads_.empty()) {
                const std::uint32_t samples = samples_of(block_of_[pixel], format_.samples);
                const auto layers_end = sound.begin() + std::ptrdiff_t(format_.layers.size());
                spreads_.note(pixel, std::accumulate(sound.begin(), layers_end, Rgb{}), double(scale_) / samples,
                              block_of_[pixel]);
            }
            block_of_[pixel] += blocks;
        }
    folded_ += tile.pixels() * blocks;
}

// DECISIONS: samples-by-cell
bool Film::enough(const Tile& cell) const {
    double sum = 0;
    for (std::uint32_t y = cell.y; y < cell.y + cell.height; ++y)
        for (std::uint32_t x = cell.x; x < cell.x + cell.width; ++x)
            sum += spreads_.noise_of(index(x, y), block_of_[index(x, y)]);
    return sum <= double(format_.refinement.noise) * double(cell.pixels());
}

double Film::done() const {
    std::uint64_t there = folded_ + spared_;
    if (!format_.adaptive() && !complete()) {
        there = 0;
        for (const auto& [area, rectangle] : rectangles_)
            there += std::uint64_t{std::get<2>(area)} * std::get<3>(area) * blocks_shown(rectangle);
    }
    return static_cast<double>(there) / static_cast<double>(all_);
}

double Film::mean_samples() const {
    double sum = 0;
    for (const auto& [area, rectangle] : rectangles_)
        sum += double(std::uint64_t{std::get<2>(area)} * std::get<3>(area)) * samples_shown(rectangle);
    const double taken = format_.coarse ? 1.0 / (coarse_stride * coarse_stride) : 1;
    return taken * sum / static_cast<double>(window_.pixels());
}

}  // namespace lightnet
