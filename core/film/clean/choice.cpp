#include "core/film/clean/choice.hpp"

#include <algorithm>
#include <utility>

namespace lightnet::cleaning {
namespace {

constexpr std::size_t choices = filters + 1;  // the first one: nothing is changed
using Plane = std::vector<float>;             // of an area

/// The filters of an area, and how good each is.
class Choosing {
public:
    Choosing(const Guide& guide, Place area, const SumChanges& changes)
        : guide_(guide), area_(area), changes_(changes) {}

    Choice choose() const {
        std::array<Plane, choices> errors, variances, spreads, parts;
        for (std::size_t c = 0; c < choices; ++c) {
            const Errors found = errors_of(c);
            errors[c] = smoothed_inside(found.all, error_radius);
            variances[c] = smoothed_inside(found.variance, error_radius);
            spreads[c] = smoothed_inside(found.spread, error_radius);
            parts[c].assign(area_side * area_side, 0);
        }
        Choice choice;
        choice.expected.resize(area_side * area_side);
        for (std::size_t i = 0; i < choice.expected.size(); ++i) {
            std::size_t best = guide_.halves ? 0 : 1;  // without halves nothing tells them apart
            for (std::size_t c = 1; c < choices && guide_.halves; ++c)
                if (errors[c][i] < errors[best][i]) best = c;
            parts[best][i] = 1;
        }
        for (std::size_t c = 0; c < choices; ++c) {
            parts[c] = smoothed_inside(parts[c], choice_radius);
            for (std::size_t i = 0; i < choice.expected.size(); ++i) {
                choice.expected[i].all += parts[c][i] * errors[c][i];
                choice.expected[i].variance += parts[c][i] * variances[c][i];
                choice.expected[i].spread += parts[c][i] * spreads[c][i];
            }
            if (c > 0) choice.parts[c - 1] = std::move(parts[c]);
        }
        return choice;
    }

private:
    // DECISIONS: errors-by-two-changes
    // Squared error of the mean of both halves when they are changed so, in parts of value² + 0.01. Each change is what
    // a filter takes for noise; as their noise has nothing in common, their product is on average the square of what
    // both are off by. Beside that, the mean of two that are apart by d has the variance d² / 4.
    struct Errors {
        Plane all, variance, spread;
    };
    Errors errors_of(std::size_t choice) const {
        Errors errors{Plane(area_side * area_side), Plane(area_side * area_side), Plane(area_side * area_side)};
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t y = 0; y < area_side; ++y) {
                const float* const a = guide_.half[0][c].at(area_.x, area_.y + std::int64_t(y));
                const float* const b = guide_.half[1][c].at(area_.x, area_.y + std::int64_t(y));
                const float *const strict_a = row(0, 0, c, y), *const strict_b = row(1, 0, c, y);
                const float* const changes_a = row(0, choice ? choice - 1 : 0, c, y);
                const float* const changes_b = row(1, choice ? choice - 1 : 0, c, y);
                for (std::size_t x = 0; x < area_side; ++x) {
                    const float change_a = choice ? changes_a[x] : 0, change_b = choice ? changes_b[x] : 0;
                    const float value = 0.5f * (a[x] + strict_a[x] + b[x] + strict_b[x]);
                    const float apart = (a[x] + change_a) - (b[x] + change_b);
                    const float part = 1 / (3 * (value * value + 0.01f)), variance = 0.25f * apart * apart;
                    const float product = change_a * change_b * part;
                    errors.all[y * area_side + x] += product + variance * part;
                    errors.spread[y * area_side + x] += 3 * product * product;
                    errors.variance[y * area_side + x] += variance * part;
                }
            }
        return errors;
    }
    const float* row(std::size_t half, std::size_t filter, std::size_t channel, std::size_t y) const {
        return changes_[half][filter].of(channel) + AreaChannels::index(0, static_cast<std::int64_t>(y));
    }

    // The mean over what is in the picture. Nearer to the area's edge than `radius` it is over less.
    Plane smoothed_inside(const Plane& plane, std::uint32_t radius) const {
        const auto inside = [](std::int64_t first, std::int64_t end) {
            return Inside{std::max<std::int64_t>(0, first), std::min<std::int64_t>(area_side, end)};
        };
        const Inside columns = inside(-area_.x, guide_.width - area_.x),
                     rows = inside(-area_.y, guide_.height - area_.y);
        Plane across(plane.size()), both(plane.size());
        for (std::int64_t y = rows.first; y < rows.end; ++y) {
            float* const sums = across.data() + y * area_side;
            add_across(plane.data() + y * area_side, columns, radius, area_side, sums);
            for (std::int64_t x = 0; x < area_side; ++x)
                sums[x] /= static_cast<float>(std::max<std::int64_t>(1, columns.count(x, radius)));
        }
        for (std::int64_t y = 0; y < area_side; ++y) {
            const auto first = std::max(rows.first, y - radius), end = std::min(rows.end, y + radius + 1);
            float* const sums = both.data() + y * area_side;
            for (auto k = first; k < end; ++k)
                for (std::size_t x = 0; x < area_side; ++x) sums[x] += across[std::size_t(k) * area_side + x];
            for (std::size_t x = 0; x < area_side && first < end; ++x) sums[x] /= float(end - first);
        }
        return both;
    }

    const Guide& guide_;
    Place area_;
    const SumChanges& changes_;
};

}  // namespace

Choice choose(const Guide& guide, Place area, const SumChanges& changes) {
    return Choosing(guide, area, changes).choose();
}

}  // namespace lightnet::cleaning
