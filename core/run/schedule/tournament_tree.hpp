// A tournament tree: the lowest key of many numbered things.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace lightnet {

/// A tournament tree: each change costs O(log n), the winner is known at once. Of equal keys the lowest number wins, so
/// that the same changes always give the same winner.
class TournamentTree {
public:
    static constexpr double none = std::numeric_limits<double>::infinity();

    /// Gives thing `number` a key; `none` takes it out.
    void set(std::size_t number, double key) {
        if (number >= leaves_) grow(number + 1);
        if (keys_[number] == key) return;
        keys_[number] = key;
        for (std::size_t match = (leaves_ + number) / 2; match > 0; match /= 2) play(match);
    }
    double key(std::size_t number) const { return number < leaves_ ? keys_[number] : none; }
    bool any() const { return least() < none; }
    /// The thing with the lowest key; only when there is any().
    std::size_t first() const { return winners_[1]; }
    double least() const { return leaves_ > 0 ? keys_[winners_[1]] : none; }

private:
    // Matches are numbered like a heap; the things are its leaves, from leaves_ on.
    std::uint32_t winner(std::size_t match) const {
        return match >= leaves_ ? static_cast<std::uint32_t>(match - leaves_) : winners_[match];
    }
    void play(std::size_t match) {
        const auto left = winner(2 * match), right = winner(2 * match + 1);
        winners_[match] = keys_[right] < keys_[left] ? right : left;
    }
    void grow(std::size_t wanted) {
        leaves_ = std::bit_ceil(wanted < 2 ? 2 : wanted);
        keys_.resize(leaves_, none);
        winners_.assign(leaves_, 0);
        for (std::size_t match = leaves_ - 1; match > 0; --match) play(match);
    }

    std::size_t leaves_ = 0;
    std::vector<double> keys_;
    std::vector<std::uint32_t> winners_;
};

}  // namespace lightnet
