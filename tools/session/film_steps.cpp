#include "tools/session/film_steps.hpp"

#include <algorithm>
#include <utility>

#include "core/film/clean/rounds.hpp"
#include "core/run/message/message.hpp"

namespace lightnet {

FilmSteps::FilmSteps(FilmFormat format, std::uint32_t tile)
    : tile_(tile), wanted_(format.samples), film_(std::move(format)) {}

const Film& FilmSteps::picture() const {
    if (coarse_ && coarse_->complete() && !last_ && film_.covered() < 1) return *coarse_;
    const bool last_is_better = last_ && (!film_.complete() || last_->format().samples > film_.format().samples);
    return last_is_better ? *last_ : film_;
}

double FilmSteps::done() const { return film_.done() * film_.format().samples / wanted_; }

bool FilmSteps::lasts(const Tile& tile) const {
    if (tile.coarse) return false;
    return tile.samples % samples_per_block == 0 || film_.format().samples == wanted_;
}

std::vector<Tile> FilmSteps::lacking() const {
    std::vector<Tile> tiles;
    for (const Tile& tile : tiles_of(film_.format(), tile_))
        for (const Tile& lacks : film_.lacking(tile)) tiles.push_back(lacks);
    return tiles;
}

std::uint64_t FilmSteps::found() const { return work_in(tiles_of(film_.format(), tile_)) - work_in(lacking()); }

void FilmSteps::restore(FilmState state) {
    if (limit_ && state.samples < wanted_ && state.samples % samples_per_block > 0) {
        FilmFormat format = film_.format();
        format.samples = state.samples;
        Film found(std::move(format));
        found.expose(film_.scale());
        found.restore(state);
        if (found.complete()) last_ = std::move(found);
    }
    film_.restore(std::move(state));
    there_ = film_.even_samples().value_or(0);
    if (there_ > 0 && !last_ && (limit_ || by_groups_)) last_ = film_.of_samples(there_);
}

void FilmSteps::clear() {
    FilmFormat format = film_.format();
    format.samples = wanted_;
    Film empty(std::move(format));
    empty.expose(film_.scale());
    film_ = std::move(empty);
    last_.reset(), coarse_.reset();
    there_ = adds_ = 0;
    begun_.reset();
}

void FilmSteps::grow_to(std::uint32_t samples) {
    if (film_.format().samples == samples) return;
    Film next = film_.of_samples(samples);
    if (film_.complete()) last_ = std::move(film_);
    film_ = std::move(next);
}

std::uint32_t FilmSteps::next_samples(Time now) const {
    // What an earlier run left is made even first.
    const bool in_steps = limit_ || by_groups_;
    if (const auto begun = film_.samples_begun(); in_steps && begun > there_) return limit_.over(now) ? 0 : begun;
    const auto next = limit_.next(there_, wanted_, now);
    if (limit_ || !by_groups_ || next == 0) return next;
    if (quick_first_ && there_ == 0) return 1;
    const Blocks group = group_of(there_ / samples_per_block);
    return std::min((group.first + group.count) * samples_per_block, wanted_);
}

std::vector<Tile> FilmSteps::next(Time now) {
    // DECISIONS: where-an-edit-goes
    if (quick_first_ && !coarse_ && !last_ && film_.samples_begun() == 0 && !limit_.over(now)) {
        coarse_.emplace(coarse_look(film_.format()));
        coarse_->expose(film_.scale());
        return tiles_of(coarse_->format(), coarse_stride * tile_);
    }
    if (film_.covered() == 1) coarse_.reset();
    if (begun_ && film_.complete()) limit_.took(std::exchange(adds_, 0), now - *begun_);
    while (true) {
        if (film_.complete()) there_ = film_.format().samples;
        const std::uint32_t samples = next_samples(now);
        if (samples == 0) return {};
        const bool uneven = film_.samples_begun() > there_;
        adds_ = uneven ? 0 : samples - there_ / samples_per_block * samples_per_block;
        grow_to(samples);
        auto tiles = lacking();
        end_round_if_over(film_);  // of a film that was taken up; what it wants is among what it goes on with
        const auto more = film_.going_on();
        tiles.insert(tiles.end(), more.begin(), more.end());
        if (!tiles.empty()) return tiles;
    }
}

void FilmSteps::end() {
    coarse_.reset();
    if (film_.complete() || last_) return;
    if (const auto samples = film_.even_samples()) film_ = film_.of_samples(*samples);
}

}  // namespace lightnet
