// The order of few numbers, without a guess: each is compared with each, many at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/math/columns.hpp"

namespace lightnet {

/// Of up to `most` numbers.
template <std::size_t most>
class Ranks {
public:
    /// `values`: `count` of them, filled up with infinity to `padded`, a multiple of the width of vectors.
    Ranks(const float* values, std::size_t count, std::size_t padded)
        : values_(values), count_(count), padded_(padded) {
        work_in_lanes(*this);
        std::size_t sum = 0;
        for (std::size_t i = 0; i < count_; ++i) sum += ranks_[i];
        all_differ_ = count_ == 0 || sum == count_ * (count_ - 1) / 2;
    }

    /// False: some are equal, and share a rank.
    bool all_differ() const { return all_differ_; }
    /// How many are less.
    std::uint32_t operator[](std::size_t i) const { return ranks_[i]; }

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < count_; ++i) {
            const float own = values_[i];
            std::uint32_t less = 0;
            for (std::size_t k = 0; k < padded_; ++k) less += values_[k] < own ? 1u : 0u;
            ranks_[i] = less;
        }
    }

private:
    const float* values_;
    std::size_t count_, padded_;
    bool all_differ_ = true;
    std::array<std::uint32_t, most> ranks_;
};

}  // namespace lightnet
