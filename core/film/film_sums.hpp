// The sums of a film: colours of pixels, added up in a fixed order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/addition.hpp"
#include "core/film/film_format.hpp"
#include "core/film/film_state.hpp"
#include "core/film/film_tiling.hpp"
#include "core/film/spreads.hpp"

namespace lightnet {

/// One thread. Black stands for what is not finite, and is counted.
class FilmSums {
public:
    /// Throws Error where there is no memory for so many pixels.
    FilmSums(const FilmFormat& format, const FilmTiling& tiling);

    /// Adds the next blocks of a tile. `scale`: what becomes of radiance in the picture, for errors as they are seen.
    void fold(const Tile& tile, std::uint32_t blocks, std::span<const Rgb> pixels, float scale);
    /// All blocks of these pixels are counted, whether they are added here or kept beside.
    void count(const Window& area, std::uint32_t blocks);
    /// What is not finite, and counts it.
    void blacken(std::span<Rgb> pixels);

    /// Pixel × colour.
    std::span<const Rgb> all() const { return sums_; }
    const std::vector<std::uint64_t>& lost() const { return lost_; }
    const Addition& addition() const { return addition_; }
    /// Cells decide by the spread of their blocks.
    bool has_spreads() const { return !spreads_.empty(); }
    /// Of pixels, added up.
    double noise_of(const Window& cell) const;

    void save(FilmState& into) const;
    /// Throws Error on one of another size.
    void restore(FilmState& from);
    /// Throws Error where a pixel has something, of which no block was counted: it would be added a second time.
    void expect_nothing_elsewhere() const;

private:
    FilmTiling tiling_;
    Addition addition_;
    std::size_t colours_, layers_;
    std::vector<Rgb> sums_;                // without groups that are open
    std::vector<std::uint32_t> block_of_;  // per pixel: how many blocks are in its sums
    Spreads spreads_;                      // where cells decide by themselves
    std::vector<std::uint64_t> lost_;
};

}  // namespace lightnet
