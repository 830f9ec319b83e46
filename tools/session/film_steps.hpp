// The film of a run, which grows step by step where the run may have to end early.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/film/film.hpp"
#include "tools/support/time_limit.hpp"

namespace lightnet {

/// A step is a picture of more samples than the one before, which it goes on from. So there is always a picture that
/// all pixels have finished, with the bytes that its number of samples gives. Without a limit and without looks in
/// between, a run is one step. Where somebody waits, a coarse look comes first, of which nothing stays. One thread's.
class FilmSteps {
public:
    using Time = TimeLimit::Time;

    /// `tile`: pixels along a side.
    FilmSteps(FilmFormat format, std::uint32_t tile);

    void limit(TimeLimit limit) { limit_ = limit; }
    const TimeLimit& limit() const { return limit_; }
    /// A step for each group of blocks, to look at. `quick_first`: after a coarse look and a step of a single sample,
    /// as there is somebody who waits for it.
    void by_groups(bool quick_first = false) { by_groups_ = true, quick_first_ = quick_first; }

    /// What is being rendered. It stays where it is.
    Film& film() { return film_; }
    const Film& film() const { return film_; }
    /// Where a tile belongs: there, or into the coarse look.
    Film& film_of(const Tile& tile) { return tile.coarse && coarse_ ? *coarse_ : film_; }
    /// What grows now: either of them.
    const Film& at_work() const { return coarse_ && film_.done() == 0 ? *coarse_ : film_; }
    /// What would be written now: the last picture that all pixels have finished; none yet: what is there, or the
    /// coarse look, until end().
    const Film& picture() const;
    /// All samples that are wanted are there.
    bool finished() const { return film_.complete() && film_.format().samples == wanted_; }
    /// 0 … 1, of the samples that are wanted.
    double done() const;
    /// What is rendered stays when more is wanted.
    bool lasts(const Tile& tile) const;
    /// Blocks of tiles that are there.
    std::uint64_t found() const;

    /// What an earlier run left. Throws Error when it does not fit.
    void restore(FilmState state);
    /// Nothing is there.
    void clear();
    /// The step that went on is over, if there was one. The tiles of the next, which begin() begins; none: there is
    /// nothing to do any more, or no time.
    std::vector<Tile> next(Time now);
    void begin(Time now) { begun_ = now; }
    /// No more is rendered. A picture that is not finished is that of as many samples as all pixels have.
    void end();

private:
    std::vector<Tile> lacking() const;
    std::uint32_t next_samples(Time now) const;
    void grow_to(std::uint32_t samples);

    std::uint32_t tile_, wanted_;  // pixels, samples
    bool by_groups_ = false, quick_first_ = false;
    TimeLimit limit_;
    Film film_;
    std::optional<Film> last_, coarse_;   // finished; the first look
    std::uint32_t there_ = 0, adds_ = 0;  // samples: that all pixels have; of the step that goes on, 0: differs
    std::optional<Time> begun_;           // that step
};

}  // namespace lightnet
