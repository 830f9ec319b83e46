#include "core/estimate/nearest.hpp"

#include <limits>

#include "core/base/math/columns.hpp"
#include "core/estimate/ranks.hpp"

namespace lightnet {
namespace {

constexpr std::size_t slack = 14;         // what may be kept beyond the nearest, so that sifting ends early
constexpr std::size_t most_ranked = 256;  // beyond it, comparing each with each costs more than sorting
constexpr int guesses_by_proportion = 6;  // before the range is halved
constexpr float nowhere = std::numeric_limits<float>::infinity();

struct Count {
    const float* distances2;
    std::size_t count;  // a multiple of `width`
    float bound;
    std::uint32_t within = 0;

    [[gnu::always_inline]] void work() {
        std::uint32_t sum = 0;
        for (std::size_t i = 0; i < count; ++i) sum += distances2[i] <= bound ? 1u : 0u;
        within = sum;
    }
};

}  // namespace

// Fills up the last vector with what is nowhere. Returns how many there are with that.
std::size_t Nearest::pad() {
    make_room();
    const std::size_t padded = (count_ + width - 1) / width * width;
    std::fill_n(distances_.begin() + std::ptrdiff_t(count_), padded - count_, nowhere);
    return padded;
}

std::size_t Nearest::count_within(float distance2) {
    const std::size_t padded = pad();  // may move them
    Count count{distances_.data(), padded, distance2};
    work_in_lanes(count);
    return count.within;
}

// Lowers the limit until hardly more than `most` are within it. Photons of an even surface are as many as the square of
// the distance is great, so that a guess in proportion is good at once.
// DECISIONS: photons-in-boxes
void Nearest::sift() {
    float low = 0, high = limit_;
    std::size_t at_low = 0, at_high = count_;
    for (int guesses = 0; at_high > most_ + slack; ++guesses) {
        const float part =
            guesses < guesses_by_proportion ? (float(most_ - at_low) + slack / 2) / float(at_high - at_low) : 0.5f;
        const float guess = low + (high - low) * part;
        if (!(low < guess && guess < high)) break;  // as many are equally near
        const std::size_t within = count_within(guess);
        (within < most_ ? low : high) = guess;
        (within < most_ ? at_low : at_high) = within;
    }
    limit_ = high;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const float distance = distances_[i];
        distances_[kept] = distance;
        indices_[kept] = indices_[i];
        kept += distance <= high;
    }
    count_ = kept;
    full_ = std::max(2 * most_ + width, kept + width);
}

// False: there are too many, or two are equally near.
bool Nearest::sort_by_rank() {
    items_.resize(count_);
    if (count_ <= most_ranked) {
        const std::size_t padded = pad();  // may move them
        const Ranks<most_ranked> ranks(distances_.data(), count_, padded);
        for (std::size_t i = 0; i < count_; ++i) items_[ranks[i]] = {distances_[i], indices_[i]};
        if (ranks.all_differ()) return true;
    }
    for (std::size_t i = 0; i < count_; ++i) items_[i] = {distances_[i], indices_[i]};
    return false;
}

}  // namespace lightnet
