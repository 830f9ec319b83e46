// A film is put down, and taken up again.
#include <algorithm>
#include <optional>
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
    into.sums = sums_;
    into.spreads = spreads_.all();
    into.lost = lost_;
    into.parts.clear();
    for (const auto& [area, rectangle] : rectangles_) {
        const auto& [x, y, width, height] = area;
        into.parts.push_back({x, y, width, height, rectangle.next_block, rectangle.waiting, rectangle.ended});
    }
}

void Film::expect_can_wait(const FilmState::Part& part) const {
    const std::size_t colours = std::size_t{part.width} * part.height * format_.colours();
    std::uint32_t free = part.next_block;
    for (const auto& [block, sum] : part.waiting) {
        const Blocks together = handed_out(block), group = group_of(block);
        const std::uint32_t left = block < blocks_ ? together.first + together.count - block : 0;
        const bool is_next = block == part.next_block && sum.blocks == group.count && !is_open(group);
        if (block < free || sum.blocks < 1 || sum.blocks > left || is_next || sum.pixels.size() != colours)
            throw Error("film", "what is taken up has a block that can't wait");
        free = block + sum.blocks;
    }
}

void Film::take_up(FilmState::Part part) {
    const Tile tile{part.x, part.y, part.width, part.height, 0, samples_of(0, format_.samples)};
    expect_valid(tile, tile.pixels() * format_.colours());
    const Area area{part.x, part.y, part.width, part.height};
    if (rectangles_.contains(area)) throw Error("film", "what is taken up has a part twice");
    if (part.next_block > blocks_) throw Error("film", "what is taken up has more samples");
    if (part.ended && !format_.in_rounds()) throw Error("film", "what is taken up has a part that ended too early");
    if (part.next_block < blocks_ && group_of(part.next_block).first != part.next_block)
        throw Error("film", "what is taken up has a part of a group");
    if (part.next_block == blocks_ && is_open(group_of(blocks_ - 1)))
        throw Error("film", "what is taken up has a group that should be apart");
    expect_can_wait(part);
    auto& rectangle = rectangle_of(tile);
    rectangle.next_block = part.next_block;
    rectangle.ended = part.ended;
    for (auto& [block, sum] : part.waiting)
        if (const Blocks together = handed_out(block); block != together.first || sum.blocks != together.count)
            blacken(sum.pixels);
    rectangle.waiting = std::move(part.waiting);
    for (std::uint32_t y = part.y; y < part.y + part.height; ++y)
        for (std::uint32_t x = part.x; x < part.x + part.width; ++x) block_of_[index(x, y)] = part.next_block;
    folded_ += tile.pixels() * part.next_block;
}

namespace {

// A part that was left out would be added a second time.
void expect_nothing_elsewhere(const std::vector<Rgb>& sums, const std::vector<PixelSpread>& spreads,
                              const std::vector<std::uint32_t>& block_of) {
    const std::size_t colours = sums.size() / block_of.size();
    for (std::size_t pixel = 0; pixel < block_of.size(); ++pixel) {
        if (block_of[pixel] > 0) continue;
        bool nothing = spreads.empty() || spreads[pixel] == PixelSpread{};
        for (std::size_t k = 0; k < colours; ++k) nothing = nothing && sums[pixel * colours + k] == Rgb{};
        if (!nothing) throw Error("film", "what is taken up lacks a part that its sums have");
    }
}

}  // namespace

void Film::restore(FilmState state) {
    if (!rectangles_.empty()) throw Error("film", "only an empty film can take up another");
    if (state.sums.size() != sums_.size() || state.spreads.size() != spreads_.all().size() ||
        state.lost.size() != lost_.size())
        throw Error("film", "what is taken up is of another size");
    if (state.samples > format_.samples) throw Error("film", "what is taken up is of more samples");
    sums_ = std::move(state.sums);
    spreads_.take(std::move(state.spreads));
    lost_ = std::move(state.lost);
    const bool grows = state.samples < format_.samples && state.samples % samples_per_block > 0;
    for (auto& part : state.parts) {
        // The block that was short is longer here, and the others must be as they are.
        if (grows) part.waiting.erase(state.samples / samples_per_block);
        take_up(std::move(part));
    }
    expect_nothing_elsewhere(sums_, spreads_.all(), block_of_);
    std::uint32_t least = blocks_, most = 0;
    for (auto& [area, rectangle] : rectangles_) {
        const auto& [x, y, width, height] = area;
        end_if_enough(rectangle, {x, y, width, height});
        end_if_open_group_is_there(rectangle, {x, y, width, height});
        if (rectangle.done) continue;
        least = std::min(least, rectangle.next_block);
        most = std::max(most, rectangle.next_block);
    }
    // Where all that go on are at the end of a round, it is ended once more, in the same way: a film of fewer samples
    // had no need to.
    if (std::find(taken_.begin(), taken_.end(), false) == taken_.end())
        round_ = round_beyond(least == most && least > 0 ? least - 1 : least, format_);
}

// None: they differ from place to place, or some are missing before others.
std::optional<std::uint32_t> Film::even_samples() const {
    std::optional<std::uint32_t> blocks;
    std::size_t pixels = 0;
    for (const auto& [area, rectangle] : rectangles_) {
        std::uint32_t there = rectangle.next_block;
        for (const auto& [block, sum] : rectangle.waiting) {
            if (block != there) return std::nullopt;
            there += sum.blocks;
        }
        if (blocks.value_or(there) != there) return std::nullopt;
        blocks = there;
        pixels += std::size_t{std::get<2>(area)} * std::get<3>(area);
    }
    if (pixels != window_.pixels() || !(blocks > 0u)) return std::nullopt;
    return std::min(*blocks * samples_per_block, format_.samples);
}

double Film::covered() const {
    std::uint64_t pixels = 0;
    for (const auto& [area, rectangle] : rectangles_)
        if (samples_shown(rectangle) > 0) pixels += std::uint64_t{std::get<2>(area)} * std::get<3>(area);
    return static_cast<double>(pixels) / static_cast<double>(window_.pixels());
}

std::uint32_t Film::samples_begun() const {
    std::uint32_t blocks = 0;
    for (const auto& [area, rectangle] : rectangles_) {
        blocks = std::max(blocks, rectangle.next_block);
        if (!rectangle.waiting.empty()) {
            const auto& [block, sum] = *rectangle.waiting.rbegin();
            blocks = std::max(blocks, block + sum.blocks);
        }
    }
    return std::min(blocks * samples_per_block, format_.samples);
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

std::vector<Tile> Film::lacking(const Tile& tile) const {
    if (has(tile)) return {};
    auto blocks = one_by_one(tile);
    const auto there = std::erase_if(blocks, [this](const Tile& block) { return has(block); });
    return there == 0 ? std::vector<Tile>{tile} : blocks;
}

}  // namespace lightnet
