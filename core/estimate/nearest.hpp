// The nearest of what a search comes upon: k nearest neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/columns.hpp"

namespace lightnet {

/// Keeps what may be among the `most` nearest, and little more, without putting it in order before the end: sifting
/// compares many distances at once, where a heap would guess wrong at every step. One thread.
class Nearest {
public:
    /// Distances that are offered at once.
    static constexpr std::size_t width = 16;

    struct Item {
        float distance2;  // as the search counts it, not negative
        std::uint32_t index;
    };

    /// `most` 0: all within the limit. Keeps its memory from search to search.
    void begin(std::size_t most, float limit) {
        most_ = full_ = most;
        limit_ = limit;
        count_ = 0;
    }

    /// What is farther need not be offered; at this distance it must be. Falls as nearer ones are found.
    float limit() const { return limit_; }

    /// Their indices follow `first`. Infinite: is not there.
    void offer(const std::array<float, width>& distances2, std::uint32_t first) {
        make_room();
        for (std::size_t i = 0; i < width; ++i) {
            distances_[count_] = distances2[i];
            indices_[count_] = first + std::uint32_t(i);
            count_ += distances2[i] <= limit_;
        }
        if (most_ && count_ >= full_) sift();
    }

    /// Ends a search: the nearest in order; `comes_first` decides between two at the same distance.
    template <class ComesFirst>
    std::span<const Item> sorted(ComesFirst&& comes_first) {
        if (most_ && count_ > most_) sift();
        if (!sort_by_rank())
            std::sort(items_.begin(), items_.end(), [&](const Item& a, const Item& b) {
                return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : comes_first(a.index, b.index);
            });
        if (most_ && items_.size() > most_) items_.resize(most_);
        return items_;
    }

private:
    void make_room() {
        if (count_ + width <= distances_.size()) return;
        distances_.resize(2 * count_ + 8 * width);
        indices_.resize(distances_.size());
    }
    std::size_t pad();
    std::size_t count_within(float distance2);
    void sift();
    bool sort_by_rank();

    std::size_t most_ = 0, full_ = 0, count_ = 0;
    float limit_ = 0;
    std::vector<float, InLines<float>> distances_;  // the first `count_` of them, with room for more behind
    std::vector<std::uint32_t> indices_;
    std::vector<Item> items_;
};

}  // namespace lightnet
