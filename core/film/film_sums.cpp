#include "core/film/film_sums.hpp"

#include <fmt/format.h>

#include <new>
#include <numeric>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {

FilmSums::FilmSums(const FilmFormat& format, const FilmTiling& tiling)
    : tiling_(tiling),
      addition_(format.addition()),
      colours_(format.colours()),
      layers_(format.layers.size()),
      lost_(format.colours()) {
    const auto& window = tiling.window();
    const std::size_t pixels = window.pixels();
    try {
        if (format.adaptive() && !format.in_rounds()) spreads_.resize(pixels);
        sums_.resize(pixels * colours_);
        block_of_.resize(pixels);
    } catch (const std::bad_alloc&) {
        throw Error(
            "film",
            fmt::format("{}x{} pixels of {} layers take {:.0f} MB, which is more than there is memory for",
                        window.width, window.height, colours_, double(pixels) * double(colours_) * sizeof(Rgb) / 1e6));
    }
}

void FilmSums::fold(const Tile& tile, std::uint32_t blocks, std::span<const Rgb> pixels, float scale) {
    const Rgb* next = pixels.data();
    std::vector<Rgb> sound(colours_);
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
            const std::size_t pixel = tiling_.index(x, y);
            for (std::size_t k = 0; k < colours_; ++k, ++next) {
                sound[k] = finite(*next) ? *next : Rgb{};
                lost_[k] += !finite(*next);
            }
            addition_(std::span(sums_).subspan(pixel * colours_, colours_), sound);
            if (!spreads_.empty()) {
                const std::uint32_t block = block_of_[pixel];
                const auto layers_end = sound.begin() + std::ptrdiff_t(layers_);
                spreads_.note(pixel, std::accumulate(sound.begin(), layers_end, Rgb{}),
                              double(scale) / tiling_.block_of({}, block).samples, block);
            }
            block_of_[pixel] += blocks;
        }
}

void FilmSums::count(const Window& area, std::uint32_t blocks) {
    for (std::uint32_t y = area.y; y < area.y + area.height; ++y)
        for (std::uint32_t x = area.x; x < area.x + area.width; ++x) block_of_[tiling_.index(x, y)] = blocks;
}

// DECISIONS: not-finite-is-black
void FilmSums::blacken(std::span<Rgb> pixels) {
    for (std::size_t i = 0; i < pixels.size(); ++i)
        if (!finite(pixels[i])) {
            pixels[i] = {};
            ++lost_[i % colours_];
        }
}

// DECISIONS: samples-by-cell
double FilmSums::noise_of(const Window& cell) const {
    double sum = 0;
    for (std::uint32_t y = cell.y; y < cell.y + cell.height; ++y)
        for (std::uint32_t x = cell.x; x < cell.x + cell.width; ++x)
            sum += spreads_.noise_of(tiling_.index(x, y), block_of_[tiling_.index(x, y)]);
    return sum;
}

void FilmSums::save(FilmState& into) const {
    into.sums = sums_;
    into.spreads = spreads_.all();
    into.lost = lost_;
}

void FilmSums::restore(FilmState& from) {
    if (from.sums.size() != sums_.size() || from.spreads.size() != spreads_.all().size() ||
        from.lost.size() != lost_.size())
        throw Error("film", "what is taken up is of another size");
    sums_ = std::move(from.sums);
    spreads_.take(std::move(from.spreads));
    lost_ = std::move(from.lost);
}

void FilmSums::expect_nothing_elsewhere() const {
    for (std::size_t pixel = 0; pixel < block_of_.size(); ++pixel) {
        if (block_of_[pixel] > 0) continue;
        bool nothing = spreads_.empty() || spreads_.all()[pixel] == PixelSpread{};
        for (std::size_t k = 0; k < colours_; ++k) nothing = nothing && sums_[pixel * colours_ + k] == Rgb{};
        if (!nothing) throw Error("film", "what is taken up lacks a part that its sums have");
    }
}

}  // namespace lightnet
