#include "core/film/clean/area.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/film/clean/pair_weights.hpp"

namespace lightnet::cleaning {
namespace {

constexpr std::size_t choices = filters + 1;  // the first one: nothing is changed
using Plane = std::vector<float>;             // of an area

/// All that is known of an area.
class AreaCleaning {
public:
    AreaCleaning(const Picture& noisy, const std::vector<const PictureLayer*>& halves, const Guide& guide, Place core)
        : noisy_(noisy),
          halves_(halves),
          guide_(guide),
          core_(core),
          area_{core.x - std::int64_t{rim}, core.y - std::int64_t{rim}},
          channels_(3 * std::max<std::size_t>(1, noisy.layers.size())) {}

    void filter() {
        PairWeights weights;
        AreaResult change(channels_ + 3);
        for (std::size_t f = 0; f < filters; ++f) {
            mixed_.emplace_back(channels_);
            for (auto& half : of_sum_) half.emplace_back(3);
        }
        for (const std::size_t half : {0, 1}) {
            const AreaValues values = values_of(half);
            for (std::size_t row = 0; row < area_side; row += strip_rows) {
                const std::int64_t y = area_.y + std::int64_t(row);
                if (y + std::int64_t{strip_rows} <= 0 || y >= std::int64_t{noisy_.height}) continue;
                weights.make(guide_, 1 - half, {area_.x, area_.y + std::int64_t(row)});
                for (std::size_t f = 0; f < filters; ++f) {
                    fit_strip(guide_, weights, f, values, area_, row, change);
                    keep(change, half, f, row);
                }
            }
        }
    }

    /// Which filter is taken where, in parts.
    void choose() {
        std::array<Plane, choices> errors, variances;
        for (std::size_t c = 0; c < choices; ++c) {
            const Errors found = errors_of(c);
            errors[c] = smoothed_inside(found.all, error_radius);
            variances[c] = smoothed_inside(found.variance, error_radius);
        }
        for (auto& part : parts_) part.assign(area_side * area_side, 0);
        expected_.assign(area_side * area_side, {});
        for (std::size_t i = 0; i < expected_.size(); ++i) {
            std::size_t best = guide_.halves ? 0 : 1;  // without halves nothing tells them apart
            for (std::size_t c = 1; c < choices && guide_.halves; ++c)
                if (errors[c][i] < errors[best][i]) best = c;
            parts_[best][i] = 1;
        }
        for (auto& part : parts_) part = smoothed_inside(part, choice_radius);
        for (std::size_t i = 0; i < expected_.size(); ++i)
            for (std::size_t c = 0; c < choices; ++c) {
                expected_[i].all += parts_[c][i] * errors[c][i];
                expected_[i].variance += parts_[c][i] * variances[c][i];
            }
    }

    void write(Picture& clean, std::vector<SquaredError>& expected) const {
        const auto x_end = std::min<std::int64_t>(core_.x + core_side, noisy_.width);
        const auto y_end = std::min<std::int64_t>(core_.y + core_side, noisy_.height);
        for (auto y = core_.y; y < y_end; ++y)
            for (auto x = core_.x; x < x_end; ++x) {
                const auto pixel = static_cast<std::size_t>(y) * noisy_.width + static_cast<std::size_t>(x);
                const auto in_y = static_cast<std::size_t>(y - area_.y), in_x = static_cast<std::size_t>(x - area_.x);
                expected[pixel] = expected_[in_y * area_side + in_x];
                if (clean.layers.empty()) clean.beauty[pixel] = changed(noisy_.beauty[pixel], 0, in_x, in_y);
                for (std::size_t l = 0; l < clean.layers.size(); ++l)
                    clean.layers[l].pixels[pixel] = changed(noisy_.layers[l].pixels[pixel], 3 * l, in_x, in_y);
            }
    }

private:
    // Of all layers, and behind them of their sum. Beyond the picture there is nothing, and its weights are 0.
    AreaValues values_of(std::size_t half) const {
        AreaValues values(channels_ + 3);
        constexpr auto r = std::int64_t{reach};
        for (std::int64_t y = -r; y < std::int64_t{area_side} + r; ++y)
            for (std::int64_t x = -r; x < std::int64_t{area_side} + r; ++x) {
                const std::int64_t px = area_.x + x, py = area_.y + y;
                if (px < 0 || py < 0 || px >= noisy_.width || py >= noisy_.height) continue;
                const auto pixel = static_cast<std::size_t>(py) * noisy_.width + static_cast<std::size_t>(px);
                for (std::size_t l = 0; 3 * l < channels_; ++l) {
                    const Rgb value = value_of(l, pixel, half);
                    *values.at(3 * l, x, y) = value.r;
                    *values.at(3 * l + 1, x, y) = value.g;
                    *values.at(3 * l + 2, x, y) = value.b;
                }
                for (std::size_t c = 0; c < 3; ++c) *values.at(channels_ + c, x, y) = *guide_.half[half][c].at(px, py);
            }
        return values;
    }

    Rgb value_of(std::size_t layer, std::size_t pixel, std::size_t half) const {
        const Rgb all = noisy_.layers.empty() ? noisy_.beauty[pixel] : noisy_.layers[layer].pixels[pixel];
        const Rgb part = halves_.empty() ? 0.5f * all : halves_[layer]->pixels[pixel];
        const Rgb value = 2 * (half ? part : all - part);
        return finite(value) ? value : Rgb{};
    }

    // The mean of both halves for the layers, each by itself for their sum.
    void keep(const AreaResult& change, std::size_t half, std::size_t filter, std::size_t row) {
        for (std::size_t y = row; y < row + strip_rows; ++y) {
            for (std::size_t c = 0; c < channels_; ++c)
                for (std::size_t x = 0; x < area_side; ++x) mixed_[filter].row(c, y)[x] += 0.5f * change.row(c, y)[x];
            for (std::size_t c = 0; c < 3; ++c)
                std::copy_n(change.row(channels_ + c, y), area_side, of_sum_[half][filter].row(c, y));
        }
    }

    // DECISIONS: errors-by-two-changes
    // Squared error of the mean of both halves when they are changed so, in parts of value² + 0.01. Each change is what
    // a filter takes for noise; as their noise has nothing in common, their product is on average the square of what
    // both are off by. Beside that, the mean of two that are apart by d has the variance d² / 4.
    struct Errors {
        Plane all, variance;
    };
    Errors errors_of(std::size_t choice) const {
        Errors errors{Plane(area_side * area_side), Plane(area_side * area_side)};
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t y = 0; y < area_side; ++y) {
                const float* const a = guide_.half[0][c].at(area_.x, area_.y + std::int64_t(y));
                const float* const b = guide_.half[1][c].at(area_.x, area_.y + std::int64_t(y));
                const float* const strict_a = of_sum_[0][0].row(c, y);
                const float* const strict_b = of_sum_[1][0].row(c, y);
                for (std::size_t x = 0; x < area_side; ++x) {
                    const float change_a = choice ? of_sum_[0][choice - 1].row(c, y)[x] : 0;
                    const float change_b = choice ? of_sum_[1][choice - 1].row(c, y)[x] : 0;
                    const float value = 0.5f * (a[x] + strict_a[x] + b[x] + strict_b[x]);
                    const float apart = (a[x] + change_a) - (b[x] + change_b);
                    const float part = 1 / (3 * (value * value + 0.01f)), variance = 0.25f * apart * apart;
                    errors.all[y * area_side + x] += (change_a * change_b + variance) * part;
                    errors.variance[y * area_side + x] += variance * part;
                }
            }
        return errors;
    }

    // The mean over what is in the picture. Nearer to the area's edge than `radius` it is over less.
    Plane smoothed_inside(const Plane& plane, std::uint32_t radius) const {
        const auto at = [&](std::int64_t from, std::int64_t end, std::int64_t i) {
            return std::pair{std::max({std::int64_t{0}, i - radius, from}),
                             std::min({std::int64_t{area_side} - 1, i + radius, end - 1})};
        };
        Plane across(plane.size()), both(plane.size());
        for (std::int64_t y = 0; y < area_side; ++y)
            for (std::int64_t x = 0; x < area_side; ++x) {
                const auto [first, last] = at(-area_.x, noisy_.width - area_.x, x);
                float sum = 0;
                for (auto k = first; k <= last; ++k) sum += plane[std::size_t(y * area_side + k)];
                across[std::size_t(y * area_side + x)] = last < first ? 0 : sum / float(last - first + 1);
            }
        for (std::int64_t y = 0; y < area_side; ++y) {
            const auto [first, last] = at(-area_.y, noisy_.height - area_.y, y);
            float* const sums = both.data() + y * area_side;
            for (auto k = first; k <= last; ++k)
                for (std::size_t x = 0; x < area_side; ++x) sums[x] += across[std::size_t(k) * area_side + x];
            for (std::size_t x = 0; x < area_side && first <= last; ++x) sums[x] /= float(last - first + 1);
        }
        return both;
    }

    Rgb changed(Rgb value, std::size_t channel, std::size_t x, std::size_t y) const {
        float* const channels[] = {&value.r, &value.g, &value.b};
        for (std::size_t c = 0; c < 3; ++c) {
            float change = 0;
            for (std::size_t f = 0; f < filters; ++f)
                change += parts_[f + 1][y * area_side + x] * mixed_[f].row(channel + c, y)[x];
            const bool was_light = *channels[c] >= 0;
            *channels[c] += change;
            if (was_light && *channels[c] < 0) *channels[c] = 0;
        }
        return value;
    }

    const Picture& noisy_;
    const std::vector<const PictureLayer*>& halves_;
    const Guide& guide_;
    Place core_, area_;
    std::size_t channels_;
    std::vector<AreaResult> mixed_;                    // by filter: what changes of all layers
    std::array<std::vector<AreaResult>, 2> of_sum_{};  // by half and filter: the same of their sum
    std::array<Plane, choices> parts_;
    std::vector<SquaredError> expected_;
};

}  // namespace

void clean_area(const Picture& noisy, const std::vector<const PictureLayer*>& halves, const Guide& guide, Place core,
                Picture& clean, std::vector<SquaredError>& expected) {
    AreaCleaning area(noisy, halves, guide, core);
    area.filter();
    area.choose();
    area.write(clean, expected);
}

}  // namespace lightnet::cleaning
