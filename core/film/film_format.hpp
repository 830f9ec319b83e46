// The format of a film: pixels, layers, samples, and the tiles that these need.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/addition.hpp"
#include "core/film/picture.hpp"
#include "core/film/tile.hpp"
#include "core/film/window.hpp"

namespace lightnet {

inline std::uint32_t blocks_in(std::uint32_t samples) { return (samples + samples_per_block - 1) / samples_per_block; }
/// Of block `block` of so many samples: the last one may be short.
inline std::uint32_t samples_of(std::uint32_t block, std::uint32_t samples) {
    return std::min(samples_per_block, samples - block * samples_per_block);
}
/// Of those blocks of so many samples that there are.
inline std::uint32_t samples_of(const Blocks& blocks, std::uint32_t samples) {
    return std::min(blocks.count * samples_per_block, samples - blocks.first * samples_per_block);
}

/// The blocks that are handed out together with block `block` of so many samples: its group, as far as the picture has
/// it. A last block that is short goes alone, so that what the others of its group add up to serves a picture of more
/// samples as well.
Blocks handed_out(std::uint32_t block, std::uint32_t samples);

/// The tiles of a part of a picture in the order in which they are handed out: one group of blocks of the whole picture
/// after the other, and within it along a Hilbert curve, so that neighbours in time are neighbours in the scene.
std::vector<Tile> tiles_of(const Window& window, std::uint32_t tile_size, std::uint32_t samples);
/// Of a whole picture.
std::vector<Tile> tiles_of(std::uint32_t width, std::uint32_t height, std::uint32_t tile_size, std::uint32_t samples);

/// Pixels get samples together with the others of their cell: the picture is cut into squares of this many pixels along
/// a side, from its upper left corner. Fixed for ever, like samples_per_block.
inline constexpr std::uint32_t cell_size = 8;

/// When a cell has samples enough. Decided from its own blocks alone, in the order of their index; of a picture that is
/// to be cleaned, from all of it, when a round is over.
struct Refinement {
    float noise = 0;          // of a cell's pixels: see Film; 0: every pixel gets all samples
    std::uint32_t least = 0;  // samples that every pixel gets; taken up to whole blocks, and at least two
    friend bool operator==(const Refinement&, const Refinement&) = default;
};

/// What a film will hold.
struct FilmFormat {
    std::uint32_t width = 0, height = 0;  // pixels
    std::vector<std::string> layers;      // names, in the order in which they add up; at least one, all different
    std::uint32_t samples = 0;            // per pixel, at most
    std::optional<Window> crop{};         // what is wanted of the picture; none: all of it
    Refinement refinement{};
    std::vector<Rgb> gains{};          // of the layers, in the beauty; empty: 1. What samples are spent on knows none
    std::vector<std::string> shown{};  // pictures beside the sum (AOVs): their colours come behind those of the layers
    std::set<std::string> facts{};     // those of `shown` that are no light: exposure is not for them
    std::map<std::string, std::uint32_t> ids{};    // those of `facts` that are ids: how many a pixel keeps
    std::map<std::string, std::string> letters{};  // of those of `shown` whose channels don't have the usual ones
    bool alpha = false, coarse = false;  // the last colour is the part of a pixel that surfaces cover; it is a coarse
                                         // look, see coarse_look()
    PictureStorage storage{};            // of the file

    /// Of one pixel: one for each layer, one or one for each id for what is beside them, and one for alpha.
    std::size_t colours() const { return first_colour(shown.size()) + alpha; }
    /// Of what is shown beside the layers, by its number there; of the number behind the last: that of alpha.
    std::size_t first_colour(std::size_t beside) const;
    /// How many colours something that is shown has.
    std::size_t width_of(const std::string& name) const;
    /// Of a layer, or of a picture beside them; that of alpha is "A".
    const std::string& name_of(std::size_t colour) const;
    /// Exposure is for it.
    bool is_light(std::size_t colour) const;
    /// How colours of pixels are added up.
    Addition addition() const;
    /// It is neither an id nor alpha.
    bool is_plain(std::size_t colour) const;
    /// What one can look at while the picture grows: the colours of layers and of what is beside them, the first of
    /// ids for all of them, and alpha.
    std::vector<std::size_t> views() const;
    /// It shows halves of the samples, by which a picture can be cleaned.
    bool halves() const;
    /// Samples differ from cell to cell.
    bool adaptive() const { return refinement.noise > 0; }
    /// Cells end by what cleaning leaves of their noise.
    bool in_rounds() const { return adaptive() && halves(); }
    /// Samples that every pixel gets.
    std::uint32_t least_samples() const;
    /// What must be rendered: the crop, and where cells decide, all of each cell that it touches, so that a pixel is
    /// the same in every crop.
    Window work() const;
};

/// Throws Error on one without pixels, samples or layers, with two layers of one name, or whose crop lies outside.
void expect_sound(const FilmFormat& format);

/// Of a first, coarse look at a picture: one sample of a quarter of its pixels, see Tile. It is complete like any other
/// film, and nothing of it goes into the picture.
FilmFormat coarse_look(FilmFormat picture);
/// The tiles that such a film needs in any case. Where cells decide, tiles are single blocks of whole cells, and
/// Film::more() gives the others.
std::vector<Tile> tiles_of(const FilmFormat& format, std::uint32_t tile_size);

/// How many blocks those cells have with which a round of such a film ends, where that is the first one of more than
/// `blocks`: the least samples, and then each time half as many more, but no more than all. All of them, where cells
/// decide by themselves.
std::uint32_t round_beyond(std::uint32_t blocks, const FilmFormat& format);

}  // namespace lightnet
