// The film: takes tiles in any order and gives the same bytes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/addition.hpp"
#include "core/film/picture.hpp"
#include "core/film/spreads.hpp"
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

/// What a film holds, to be kept and taken up again, by a film of as many samples or more. A value.
struct FilmState {
    /// What came before its turn, or before all of its group.
    struct Sum {
        std::uint32_t blocks = 0;
        std::vector<Rgb> pixels;
        friend bool operator==(const Sum&, const Sum&) = default;
    };
    using Waiting = std::map<std::uint32_t, Sum>;  // by first block
    /// One rectangle of the tiling.
    struct Part {
        std::uint32_t x = 0, y = 0, width = 0, height = 0;
        std::uint32_t next_block = 0;  // the first one that is not in the sums
        Waiting waiting;
        bool ended = false;  // by a round
        friend bool operator==(const Part&, const Part&) = default;
    };
    std::uint32_t samples = 0;         // of its film
    std::vector<Rgb> sums;             // pixel × layer
    std::vector<PixelSpread> spreads;  // per pixel, where cells decide by themselves
    std::vector<std::uint64_t> lost;
    std::vector<Part> parts;
    friend bool operator==(const FilmState&, const FilmState&) = default;
};

/// Adds up the blocks of samples of each pixel, group by group, in the order of their index, whatever the order in
/// which they arrive, whether a group comes as a whole or block by block, and however the picture was cut into tiles.
/// Rectangles of one film are those of one tiling. Owned by whoever makes the picture; one thread.
///
/// What is not finite of a block counts as black. A group with such a colour is not taken: its blocks are wanted one by
/// one, so that no more is lost than if it had never been added up elsewhere. Where cells decide, a group is one block.
///
/// The last group may be one to which a picture of more samples would add. It is kept beside the sums of the others and
/// added for the picture only, so that such a picture can go on from what this film holds.
///
/// With a refinement (adaptive sampling with a noise threshold), a cell is done when the mean of its pixels' noise is
/// at most what is wanted, or when it has all samples. A pixel's noise is Σ√v / n(Σm) over its channels: m is the mean
/// of its k blocks as the picture shows it, v = Σ(b - m)² / (k (k - 1)) the variance of that mean, and n(x) the root of
/// x, or x where that is more than 1. So dark parts count as the eye sees them: Dammertz et al. 2009, "A Hierarchical
/// Automatic Stopping Condition for Monte Carlo Global Illumination", and Cycles' threshold of that name. Blocks of a
/// scrambled sequence complete each other, so v is rather too large than too small; what no block has found (a caustic
/// that is met once in a thousand samples) it can't know of, and as samples decide about their own number, pixels come
/// out too dark by a part of their error.
///
/// A film that shows halves, by which a picture is cleaned, does so in rounds: as soon as all cells that go on have
/// their least samples, half as many more, and so on, the picture so far is cleaned, and those cells end whose noise,
/// by what clean() says that they are still off by, is at most what is wanted.
class Film {
public:
    /// Throws Error on a format without pixels, samples or layers, or with two layers of one name.
    explicit Film(FilmFormat format);

    /// Takes the sums of a tile: a colour per pixel (row by row) and layer, side by side. False when the film has all
    /// of it already (the first one counts), or can't take it as a whole. Throws Error on a tile that is none of this
    /// film's.
    bool add(const Tile& tile, std::span<const Rgb> pixels);

    /// What becomes of radiance in the picture, for errors as they are seen. Before the first tile.
    void expose(float scale) { scale_ = scale; }
    float scale() const { return scale_; }
    /// The tiles that are wanted now that `tile` has come: those cells of it that aren't done, or its blocks if it
    /// could not be taken as a whole.
    std::vector<Tile> more(const Tile& tile) const;
    /// All tiles that a film that was taken up goes on with, beside what tiles_of() gives.
    std::vector<Tile> going_on() const;

    /// No tile is wanted any more before end_round(). False where cells decide by themselves.
    bool round_is_over() const;
    /// Takes what is left of the noise of each pixel of picture(), and gives what is wanted for the next round.
    std::vector<Tile> end_round(std::span<const double> noise);

    /// Is all of this tile there already?
    bool has(const Tile& tile) const;
    /// What of this tile is not: all of it, nothing, or those of its blocks that are wanted one by one.
    std::vector<Tile> lacking(const Tile& tile) const;
    FilmState state() const;
    /// Writes state() into room that is there already.
    void state(FilmState& into) const;
    /// Takes up what another film of this format held, or one of fewer samples. This one must be empty. Throws Error
    /// when it does not fit.
    void restore(FilmState state);

    /// Samples per pixel where all have as many, and nothing beyond waits; none: they differ, or have none.
    std::optional<std::uint32_t> even_samples() const;
    /// The part of the pixels of which a picture would show something, 0 … 1.
    double covered() const;
    /// As many as a picture must have at least to take up all that is there.
    std::uint32_t samples_begun() const;
    /// A film of so many samples, no fewer than were begun, with all that is there. A short last block is left out
    /// where there are to be more.
    Film of_samples(std::uint32_t samples) const;

    /// Every block that is wanted of every pixel is there.
    bool complete() const { return folded_ + spared_ == all_; }
    /// How much of it is there, 0 … 1.
    double done() const;
    /// Samples per pixel so far, on average; of a coarse look, those that were taken.
    double mean_samples() const;
    /// Colours that were not finite and count as black, per layer.
    std::vector<std::uint64_t> lost() const;
    const FilmFormat& format() const { return format_; }

    /// The mean over all samples, times `scale`. Of an incomplete film: what is there, over the samples of the blocks
    /// that each pixel has without a gap, which is what a picture of so many samples has there; where pixels differ in
    /// that, the picture says how many each has.
    Picture picture(float scale = 1) const;
    /// A tile that has been added, as picture() shows it, exposed as expose() said: a colour per pixel (row by row) and
    /// one of FilmFormat::views(), side by side; ids in false_colour(), alpha as grey. For looking at a picture while
    /// it grows.
    std::vector<Rgb> so_far(const Tile& tile) const;
    /// All that have been added, each place once.
    std::vector<Tile> areas() const;

private:
    /// What pixels show: sums of colours, of so many samples.
    struct Shown {
        std::span<const Rgb> sums;
        std::vector<std::uint32_t> samples;
        std::vector<Rgb> own;  // the sums, where they are not the film's
    };
    void add_beside(Picture& picture, const Shown& all, std::span<const std::size_t> from, float scale) const;

    struct Rectangle {
        std::uint32_t next_block = 0;  // the first one that is not in the sums
        FilmState::Waiting waiting;
        bool done = false;   // needs no further block
        bool ended = false;  // by a round
        bool has(std::uint32_t block) const;
    };
    using Area = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;  // x, y, width, height

    void take_room(std::size_t pixels);
    void expect_valid(const Tile& tile, std::size_t colours) const;
    bool has_area(const Tile& tile) const;
    std::optional<Tile> next_of(const Tile& place) const;
    void end_if_enough(Rectangle& rectangle, const Tile& tile);
    Blocks group_of(std::uint32_t block) const;
    Blocks handed_out(std::uint32_t block) const;
    bool is_open(const Blocks& group) const;
    void end_if_open_group_is_there(Rectangle& rectangle, const Tile& tile);
    static std::uint32_t blocks_shown(const Rectangle& rectangle);
    std::uint32_t samples_shown(const Rectangle& rectangle) const;
    std::vector<Rgb> sum_of_begun_group(const Rectangle& rectangle) const;
    void add_begun_group(const Rectangle& rectangle, const Tile& area, const Tile& among, std::span<Rgb> sums) const;
    Shown shown() const;
    Shown shown_of(const Tile& tile) const;
    Rgb seen_as(std::size_t view, std::span<const Rgb> pixel, float samples) const;
    void expect_can_wait(const FilmState::Part& part) const;
    void take_up(FilmState::Part part);
    bool is_whole(const Tile& tile) const;
    bool add_area(const Tile& tile, std::span<const Rgb> pixels);
    void keep(Rectangle& rectangle, const Tile& tile, std::span<const Rgb> pixels);
    std::vector<Tile> cells_of(const Tile& tile) const;
    Rectangle& rectangle_of(const Tile& tile);
    void blacken(std::span<Rgb> pixels);
    void fold(const Tile& tile, std::uint32_t blocks, std::span<const Rgb> pixels);
    void fold_next(Rectangle& rectangle, const Tile& tile, std::span<const Rgb> pixels);
    bool enough(const Tile& cell) const;
    std::size_t index(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{y - window_.y} * window_.width + (x - window_.x);
    }

    FilmFormat format_;
    Addition addition_;
    Window window_;
    float scale_ = 1;
    std::uint32_t blocks_ = 0;
    std::vector<Rgb> sums_;                // pixel × layer; without groups that are open
    std::vector<std::uint32_t> block_of_;  // per pixel: how many blocks are in its sums
    Spreads spreads_;                      // where cells decide by themselves
    std::uint32_t round_ = 0;              // blocks at which cells that go on wait for each other
    std::vector<bool> taken_;              // per pixel: it lies in a rectangle that was seen
    std::map<Area, Rectangle> rectangles_;
    std::uint64_t folded_ = 0, spared_ = 0, all_ = 0;  // pixels × blocks: in the sums, not needed, at most
    std::vector<std::uint64_t> lost_;
};

}  // namespace lightnet
