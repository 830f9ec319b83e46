// A film is put down, and taken up again.
#include <utility>

#include "core/error.hpp"
#include "core/film/film.hpp"

namespace lightnet {

FilmState Film::state() const {
    FilmState made;
    state(made);
    return made;
}

void Film::state(FilmState& into) const {
    into.sums = sums_;
    into.spreads = spreads_;
    into.lost = lost_;
    into.parts.clear();
    for (const auto& [area, rectangle] : rectangles_) {
        const auto& [x, y, width, height] = area;
        into.parts.push_back({x, y, width, height, rectangle.next_block, rectangle.waiting});
    }
}

void Film::restore(FilmState state) {
    if (!rectangles_.empty()) throw Error("film", "only an empty film can take up another");
    if (state.sums.size() != sums_.size() || state.spreads.size() != spreads_.size() ||
        state.lost.size() != lost_.size())
        throw Error("film", "what is taken up is of another size");
    for (auto& part : state.parts) {
        Tile tile{part.x, part.y, part.width, part.height, 0, samples_of(0, format_.samples)};
        expect_valid(tile, tile.pixels() * format_.colours());
        if (part.next_block > blocks_) throw Error("film", "what is taken up has more samples");
        if (part.next_block < blocks_ && group_of(part.next_block).first != part.next_block)
            throw Error("film", "what is taken up has a part of a group");
        std::uint32_t free = part.next_block;
        for (const auto& [block, sum] : part.waiting) {
            const Blocks group = group_of(block);
            const std::uint32_t left = block < blocks_ ? group.first + group.count - block : 0;
            const bool is_next = block == part.next_block && sum.blocks == group.count;
            if (block < free || sum.blocks < 1 || sum.blocks > left || is_next ||
                sum.pixels.size() != tile.pixels() * format_.colours())
                throw Error("film", "what is taken up has a block that can't wait");
            free = block + sum.blocks;
        }
        auto& rectangle = rectangle_of(tile);
        rectangle.next_block = part.next_block;
        rectangle.waiting = std::move(part.waiting);
        for (std::uint32_t y = part.y; y < part.y + part.height; ++y)
            for (std::uint32_t x = part.x; x < part.x + part.width; ++x) block_of_[index(x, y)] = part.next_block;
        folded_ += tile.pixels() * part.next_block;
    }
    sums_ = std::move(state.sums);
    spreads_ = std::move(state.spreads);
    for (auto& [area, rectangle] : rectangles_) {
        const auto& [x, y, width, height] = area;
        end_if_enough(rectangle, {x, y, width, height});
    }
    lost_ = std::move(state.lost);
}

}  // namespace lightnet
