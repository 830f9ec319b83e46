#include "core/film/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <set>
#include <utility>

#include "core/error.hpp"

namespace lightnet {
namespace {

struct Cell {
    std::uint32_t x = 0, y = 0;
};

// The d-th cell of a Hilbert curve through a square of `side` (a power of two) cells.
Cell hilbert(std::uint32_t side, std::uint64_t d) {
    Cell cell;
    for (std::uint32_t s = 1; s < side; s *= 2, d /= 4) {
        const bool right = d & 2, up = (d ^ (d >> 1)) & 1;
        if (!up) {
            if (right) cell = {s - 1 - cell.x, s - 1 - cell.y};
            std::swap(cell.x, cell.y);
        }
        cell.x += right ? s : 0;
        cell.y += up ? s : 0;
    }
    return cell;
}

std::uint32_t blocks_in(std::uint32_t samples) { return (samples + samples_per_block - 1) / samples_per_block; }

// Samples of block `block`; the last one may be short.
std::uint32_t samples_of(std::uint32_t block, std::uint32_t samples) {
    return std::min(samples_per_block, samples - block * samples_per_block);
}

}  // namespace

std::vector<Tile> tiles_of(std::uint32_t width, std::uint32_t height, std::uint32_t tile_size, std::uint32_t samples) {
    if (!width || !height || !tile_size) return {};
    const std::uint32_t columns = (width - 1) / tile_size + 1, rows = (height - 1) / tile_size + 1;
    const std::uint32_t side = std::bit_ceil(std::max(columns, rows));
    std::vector<Tile> tiles;
    tiles.reserve(std::size_t{columns} * rows * blocks_in(samples));
    for (std::uint64_t d = 0; d < std::uint64_t{side} * side; ++d) {
        const auto [column, row] = hilbert(side, d);
        if (column >= columns || row >= rows) continue;
        const std::uint32_t x = column * tile_size, y = row * tile_size;
        tiles.push_back({x, y, std::min(tile_size, width - x), std::min(tile_size, height - y), 0, 0});
    }
    const std::size_t per_block = tiles.size();
    if (blocks_in(samples) == 0) return {};
    for (std::uint32_t block = 0; block < blocks_in(samples); ++block)
        for (std::size_t i = 0; i < per_block; ++i) {
            if (block > 0) tiles.push_back(tiles[i]);
            Tile& tile = tiles[block * per_block + i];
            tile.first_sample = block * samples_per_block;
            tile.samples = samples_of(block, samples);
        }
    return tiles;
}

Film::Film(FilmFormat format) : format_(std::move(format)), blocks_(blocks_in(format_.samples)) {
    const auto& layers = format_.layers;
    if (!format_.width || !format_.height) throw Error("film", "a picture needs at least one pixel");
    if (!format_.samples) throw Error("film", "a picture needs at least one sample per pixel");
    if (layers.empty()) throw Error("film", "a picture needs at least one layer");
    if (std::set<std::string>(layers.begin(), layers.end()).size() != layers.size())
        throw Error("film", "two layers have the same name");
    const std::size_t pixels = std::size_t{format_.width} * format_.height;
    sums_.resize(pixels * layers.size());
    block_of_.resize(pixels);
    taken_.resize(pixels);
    lost_.resize(layers.size());
}

bool Film::add(const Tile& tile, std::span<const Rgb> pixels) {
    expect_valid(tile, pixels.size());
    auto& rectangle = rectangle_of(tile);
    const std::uint32_t block = tile.block();
    if (block < rectangle.next_block || rectangle.waiting.contains(block)) return false;
    if (block > rectangle.next_block) {
        rectangle.waiting.emplace(block, std::vector<Rgb>(pixels.begin(), pixels.end()));
        return true;
    }
    fold(tile, pixels);
    ++rectangle.next_block;
    for (auto next = rectangle.waiting.begin(); next != rectangle.waiting.end() && next->first == rectangle.next_block;
         next = rectangle.waiting.erase(next)) {
        fold(tile, next->second);
        ++rectangle.next_block;
    }
    return true;
}

bool Film::has(const Tile& tile) const {
    const auto known = rectangles_.find({tile.x, tile.y, tile.width, tile.height});
    return known != rectangles_.end() &&
           (tile.block() < known->second.next_block || known->second.waiting.contains(tile.block()));
}

FilmState Film::state() const {
    FilmState state{sums_, lost_, {}};
    for (const auto& [area, rectangle] : rectangles_) {
        const auto& [x, y, width, height] = area;
        state.parts.push_back({x, y, width, height, rectangle.next_block, rectangle.waiting});
    }
    return state;
}

void Film::restore(FilmState state) {
    if (!rectangles_.empty()) throw Error("film", "only an empty film can take up another");
    if (state.sums.size() != sums_.size() || state.lost.size() != lost_.size())
        throw Error("film", "what is taken up is of another size");
    for (auto& part : state.parts) {
        Tile tile{part.x, part.y, part.width, part.height, 0, samples_of(0, format_.samples)};
        expect_valid(tile, tile.pixels() * format_.layers.size());
        if (part.next_block > blocks_) throw Error("film", "what is taken up has more samples");
        auto& rectangle = rectangle_of(tile);
        rectangle.next_block = part.next_block;
        for (auto& [block, pixels] : part.waiting) {
            if (block <= part.next_block || block >= blocks_)
                throw Error("film", "what is taken up has a block that can't wait");
            tile.first_sample = block * samples_per_block;
            tile.samples = samples_of(block, format_.samples);
            expect_valid(tile, pixels.size());
        }
        rectangle.waiting = std::move(part.waiting);
        for (std::uint32_t y = part.y; y < part.y + part.height; ++y)
            for (std::uint32_t x = part.x; x < part.x + part.width; ++x)
                block_of_[std::size_t{y} * format_.width + x] = part.next_block;
        folded_ += tile.pixels() * part.next_block;
    }
    sums_ = std::move(state.sums);
    lost_ = std::move(state.lost);
}

void Film::expect_valid(const Tile& tile, std::size_t colours) const {
    const bool inside = tile.width > 0 && tile.height > 0 && tile.x < format_.width && tile.y < format_.height &&
                        tile.width <= format_.width - tile.x && tile.height <= format_.height - tile.y;
    const bool one_block = tile.first_sample % samples_per_block == 0 && tile.first_sample < format_.samples &&
                           tile.samples == samples_of(tile.block(), format_.samples);
    if (!inside || !one_block)
        throw Error("film", fmt::format("no tile of this picture: {}x{} pixels at {},{}, {} samples from {}",
                                        tile.width, tile.height, tile.x, tile.y, tile.samples, tile.first_sample));
    if (colours != tile.pixels() * format_.layers.size())
        throw Error("film", fmt::format("a tile of {} pixels and {} layers came with {} colours", tile.pixels(),
                                        format_.layers.size(), colours));
}

Film::Rectangle& Film::rectangle_of(const Tile& tile) {
    const Area area{tile.x, tile.y, tile.width, tile.height};
    if (const auto known = rectangles_.find(area); known != rectangles_.end()) return known->second;
    // Tiles that overlap would add samples twice, so the first tiling that is seen is the only one.
    for (const bool claim : {false, true})
        for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
                auto&& pixel = taken_[std::size_t{y} * format_.width + x];
                if (!claim && pixel) throw Error("film", fmt::format("two tiles overlap at pixel {},{}", x, y));
                if (claim) pixel = true;
            }
    return rectangles_[area];
}

void Film::fold(const Tile& tile, std::span<const Rgb> pixels) {
    const std::size_t layers = format_.layers.size();
    const Rgb* next = pixels.data();
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
            const std::size_t pixel = std::size_t{y} * format_.width + x;
            for (std::size_t k = 0; k < layers; ++k, ++next) {
                if (finite(*next))
                    sums_[pixel * layers + k] += *next;
                else
                    ++lost_[k];
            }
            ++block_of_[pixel];
        }
    folded_ += tile.pixels();
}

double Film::done() const {
    return static_cast<double>(folded_) / (static_cast<double>(blocks_) * format_.width * format_.height);
}

Picture Film::picture(float scale) const {
    const std::size_t pixels = block_of_.size(), layers = format_.layers.size();
    Picture picture{format_.width, format_.height, {}, {}};
    for (std::size_t k = 0; k < layers; ++k) {
        auto& layer = picture.layers.emplace_back(PictureLayer{format_.layers[k], std::vector<Rgb>(pixels)});
        for (std::size_t i = 0; i < pixels; ++i) {
            const std::uint32_t samples = std::min(block_of_[i] * samples_per_block, format_.samples);
            if (samples) layer.pixels[i] = sums_[i * layers + k] / static_cast<float>(samples) * scale;
        }
    }
    picture.beauty = sum_of(picture.layers);
    return picture;
}

}  // namespace lightnet
