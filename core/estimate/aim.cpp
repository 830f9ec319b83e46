#include "core/estimate/aim.hpp"

#include "core/base/math/prefix_cdf.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

constexpr std::size_t least_trials = 16;  // of use, in a cell that is divided
constexpr std::size_t slices = 8;         // at whose borders it may be divided
constexpr int most_divisions = 32;        // one after the other
constexpr double even_share = 0.15;       // of all light, for what trials overlooked
constexpr double worth_dividing = 0.99;   // what is left of the deviation, at most

}  // namespace

double Aim::Cell::volume() const {
    double volume = 1;
    for (std::size_t i = 0; i < low.size(); ++i) volume *= double{high[i]} - low[i];
    return volume;
}

// DECISIONS: aimed-photons
Aim::Aim(std::span<const Trial> trials) {
    std::vector<Trial> all(trials.begin(), trials.end());
    divide(Cell{}, all, 0);
    std::vector<double> shares;
    double total = 0;
    for (const Cell& cell : cells_) total += cell.gain;
    for (const Cell& cell : cells_)
        shares.push_back(total > 0 ? even_share * cell.volume() + (1 - even_share) * cell.gain / total : cell.volume());
    prefix_cdf(shares, ends_);
}

// Of light with that density in the cell, the deviation is least when cells are chosen in proportion to this.
double Aim::gain_of(const Cell& cell, std::span<const Trial> trials) {
    double squares = 0;
    for (const Trial& trial : trials) squares += trial.square();
    return std::sqrt(cell.volume() * squares);
}

// The dimension, and where in it, that leave the least deviation; past the last dimension if none leaves less than
// `least`. Not in the middle only: what is useful often is the middle.
std::pair<std::size_t, float> Aim::border_in(const Cell& cell, std::span<const Trial> trials, double least) {
    std::pair<std::size_t, float> best{cell.low.size(), 0};
    for (std::size_t i = 0; i < cell.low.size(); ++i) {
        const float low = cell.low[i], size = cell.high[i] - low;
        if (size < slices * Trial::step) continue;
        std::array<double, slices> squares{};
        double all = 0;
        for (const Trial& trial : trials) {
            const double square = trial.square();
            squares[std::min(slices - 1, std::size_t((trial.number(i) - low) / size * slices))] += square;
            all += square;
        }
        double below = 0;
        for (std::size_t k = 1; k < slices; ++k) {
            below += squares[k - 1];
            const double part = double(k) / slices;
            const double gain = std::sqrt(cell.volume()) *
                                (std::sqrt(part * below) + std::sqrt((1 - part) * std::max(0.0, all - below)));
            if (gain >= least) continue;
            least = gain;
            best = {i, low + size * float(part)};
        }
    }
    return best;
}

void Aim::divide(const Cell& cell, std::span<Trial> trials, int depth) {
    Cell whole = cell;
    whole.gain = gain_of(cell, trials);
    if (trials.size() < least_trials || depth >= most_divisions || !(whole.gain > 0)) {
        cells_.push_back(whole);
        return;
    }
    const auto [best, border] = border_in(cell, trials, worth_dividing * whole.gain);
    if (best == cell.low.size()) {
        cells_.push_back(whole);
        return;
    }
    const auto second =
        std::stable_partition(trials.begin(), trials.end(),
                              [&, at = best, end = border](const Trial& trial) { return trial.number(at) < end; });
    const auto first_half = std::size_t(second - trials.begin());
    Cell below = cell, above = cell;
    below.high[best] = above.low[best] = border;
    divide(below, trials.first(first_half), depth + 1);
    divide(above, trials.subspan(first_half), depth + 1);
}

Aim::Choice Aim::choose(Samples& samples) const {
    float u = samples.next();
    const std::size_t at = pick(ends_, u);
    const Cell& cell = cells_[at];
    const float which = samples.next();
    const Vec2 where = samples.next_2d(), direction = samples.next_2d();
    Choice choice{{which, where.x, where.y, direction.x, direction.y}, float(cell.volume()) / share_of(ends_, at)};
    for (std::size_t i = 0; i < choice.numbers.size(); ++i)
        choice.numbers[i] = std::min(cell.low[i] + choice.numbers[i] * (cell.high[i] - cell.low[i]),
                                     std::nextafter(cell.high[i], 0.0f));
    return choice;
}

}  // namespace lightnet
