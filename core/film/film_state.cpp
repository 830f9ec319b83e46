// A film is put down, and taken up again.
#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/film/film.hpp"

namespace lightnet {

FilmState Film::state() const {
    FilmState made;
    state(made);
    return made;
}

void Film::state(FilmState& into) const {
    into.samples = format_.samples;
    sums_.save(into);
    into.parts.clear();
    for (const auto& [area, part] : parts_)
        into.parts.push_back({area.x, area.y, area.width, area.height, part.next_block, part.waiting, part.ended});
}

namespace {

void expect_can_wait(const FilmState::Part& part, const FilmTiling& tiling, std::size_t colours) {
    std::uint32_t free = part.next_block;
    for (const auto& [block, sum] : part.waiting) {
        const Blocks together = tiling.handed_out(block);
        const std::uint32_t left = block < tiling.blocks() ? together.first + together.count - block : 0;
        const bool is_next = block == part.next_block && tiling.comes_next(block, sum.blocks);
        if (block < free || sum.blocks < 1 || sum.blocks > left || is_next || sum.pixels.size() != colours)
            throw Error("film", "what is taken up has a block that can't wait");
        free = block + sum.blocks;
    }
}

}  // namespace

void Film::take_up(FilmState::Part part) {
    const Window area{part.x, part.y, part.width, part.height};
    const std::size_t colours = area.pixels() * format_.colours();
    const std::uint32_t blocks = tiling_.blocks();
    tiling_.expect_valid(tiling_.block_of(area, 0), colours);
    if (parts_.find(area)) throw Error("film", "what is taken up has a part twice");
    if (part.next_block > blocks) throw Error("film", "what is taken up has more samples");
    if (part.ended && !format_.in_rounds()) throw Error("film", "what is taken up has a part that ended too early");
    if (part.next_block < blocks && tiling_.group_of(part.next_block).first != part.next_block)
        throw Error("film", "what is taken up has a part of a group");
    if (part.next_block == blocks && tiling_.is_open(tiling_.group_of(blocks - 1)))
        throw Error("film", "what is taken up has a group that should be apart");
    expect_can_wait(part, tiling_, colours);
    auto& taken = parts_.claim(area, tiling_);
    taken.next_block = part.next_block;
    taken.ended = part.ended;
    for (auto& [block, sum] : part.waiting)
        if (const Blocks together = tiling_.handed_out(block); block != together.first || sum.blocks != together.count)
            sums_.blacken(sum.pixels);
    taken.waiting = std::move(part.waiting);
    sums_.count(area, part.next_block);
    folded_ += area.pixels() * part.next_block;
}

void Film::restore(FilmState state) {
    if (!parts_.empty()) throw Error("film", "only an empty film can take up another");
    if (state.samples > format_.samples) throw Error("film", "what is taken up is of more samples");
    sums_.restore(state);
    const bool grows = state.samples < format_.samples && state.samples % samples_per_block > 0;
    for (auto& part : state.parts) {
        // The block that was short is longer here, and the others must be as they are.
        if (grows) part.waiting.erase(state.samples / samples_per_block);
        take_up(std::move(part));
    }
    sums_.expect_nothing_elsewhere();
    std::uint32_t least = tiling_.blocks(), most = 0;
    for (auto& [area, part] : parts_) {
        end_if_enough(part, area);
        end_if_open_group_is_there(part, area);
        if (part.done) continue;
        least = std::min(least, part.next_block);
        most = std::max(most, part.next_block);
    }
    // Where all that go on are at the end of a round, it is ended once more, in the same way: a film of fewer samples
    // had no need to.
    if (parts_.everywhere()) round_ = round_beyond(least == most && least > 0 ? least - 1 : least, format_);
}

// DECISIONS: ends-where-pixels-are-even
Film Film::of_samples(std::uint32_t samples) const {
    if (samples < format_.samples && samples_begun() > samples)
        throw Error("film", "it has more samples than it is to have");
    FilmFormat format = format_;
    format.samples = samples;
    FilmState held = state();
    held.samples = std::min(samples, format_.samples);
    Film made(std::move(format));
    made.expose(scale_);
    made.restore(std::move(held));
    return made;
}

}  // namespace lightnet
