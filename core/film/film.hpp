// Where the picture grows: takes tiles in any order and gives the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/film/picture.hpp"
#include "core/film/tile.hpp"
#include "core/math/rgb.hpp"

namespace lightnet {

/// The tiles of a picture in the order in which they are handed out: one block of samples of the whole picture after
/// the other, and within a block along a Hilbert curve, so that neighbours in time are neighbours in the scene.
std::vector<Tile> tiles_of(std::uint32_t width, std::uint32_t height, std::uint32_t tile_size, std::uint32_t samples);

/// What a film will hold.
struct FilmFormat {
    std::uint32_t width = 0, height = 0;  // pixels
    std::vector<std::string> layers;      // names, in the order in which they add up; at least one, all different
    std::uint32_t samples = 0;            // per pixel
};

/// What a film holds, to be kept and taken up again. A value.
struct FilmState {
    /// One rectangle of the tiling.
    struct Part {
        std::uint32_t x = 0, y = 0, width = 0, height = 0;
        std::uint32_t next_block = 0;                       // the first one that is not in the sums
        std::map<std::uint32_t, std::vector<Rgb>> waiting;  // blocks that came before their turn
        friend bool operator==(const Part&, const Part&) = default;
    };
    std::vector<Rgb> sums;  // pixel × layer
    std::vector<std::uint64_t> lost;
    std::vector<Part> parts;
    friend bool operator==(const FilmState&, const FilmState&) = default;
};

/// Adds up the blocks of samples of each pixel in the order of their index, whatever the order in which they arrive and
/// however the picture was cut into tiles. Rectangles of one film are those of one tiling. Owned by whoever makes the
/// picture; one thread.
class Film {
public:
    /// Throws Error on a format without pixels, samples or layers, or with two layers of one name.
    explicit Film(FilmFormat format);

    /// Takes the sums of one block: a colour per pixel (row by row) and layer, side by side. False when the film has
    /// that block already (the first one counts). Throws Error on a tile that is none of this film's.
    bool add(const Tile& tile, std::span<const Rgb> pixels);

    /// Is this block there already?
    bool has(const Tile& tile) const;
    FilmState state() const;
    /// Takes up what another film of this format held. This one must be empty. Throws Error when it does not fit.
    void restore(FilmState state);

    /// Every block of every pixel is there.
    bool complete() const { return folded_ == std::uint64_t{blocks_} * format_.width * format_.height; }
    /// How much of it is there, 0 … 1.
    double done() const;
    /// Colours that were not finite and count as black, per layer.
    const std::vector<std::uint64_t>& lost() const { return lost_; }
    const FilmFormat& format() const { return format_; }

    /// The mean over all samples, times `scale`. Of an incomplete film: what is there, over the samples of the blocks
    /// that each pixel has.
    Picture picture(float scale = 1) const;

private:
    struct Rectangle {
        std::uint32_t next_block = 0;                       // the first one that is not in the sums
        std::map<std::uint32_t, std::vector<Rgb>> waiting;  // blocks that came before their turn
    };
    using Area = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;  // x, y, width, height

    void expect_valid(const Tile& tile, std::size_t colours) const;
    Rectangle& rectangle_of(const Tile& tile);
    void fold(const Tile& tile, std::span<const Rgb> pixels);

    FilmFormat format_;
    std::uint32_t blocks_ = 0;
    std::vector<Rgb> sums_;                // pixel × layer
    std::vector<std::uint32_t> block_of_;  // per pixel: how many blocks are in its sums
    std::vector<bool> taken_;              // per pixel: it lies in a rectangle that was seen
    std::map<Area, Rectangle> rectangles_;
    std::uint64_t folded_ = 0;  // pixels × blocks in the sums
    std::vector<std::uint64_t> lost_;
};

}  // namespace lightnet
