// The film: takes tiles in any order and gives the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/film/film_format.hpp"
#include "core/film/film_parts.hpp"
#include "core/film/film_state.hpp"
#include "core/film/film_sums.hpp"
#include "core/film/film_tiling.hpp"
#include "core/film/picture.hpp"
#include "core/film/tile.hpp"

namespace lightnet {

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
    std::optional<Tile> next_of(const Tile& place) const;
    bool add_area(const Tile& tile, std::span<const Rgb> pixels);
    void fold_next(FilmPart& part, const Tile& tile, std::span<const Rgb> pixels);
    void keep(FilmPart& part, const Tile& tile, std::span<const Rgb> pixels);
    void end_if_enough(FilmPart& part, const Window& area);
    void end_if_open_group_is_there(FilmPart& part, const Window& area);
    void take_up(FilmState::Part part);

    FilmFormat format_;
    FilmTiling tiling_;
    float scale_ = 1;
    FilmSums sums_;
    FilmParts parts_;
    std::uint32_t round_ = 0;                          // blocks at which cells that go on wait for each other
    std::uint64_t folded_ = 0, spared_ = 0, all_ = 0;  // pixels × blocks: in the sums, not needed, at most
};

}  // namespace lightnet
