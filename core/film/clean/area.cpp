#include "core/film/clean/area.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/film/clean/changes.hpp"

namespace lightnet::cleaning {

struct AreaScratch {
    /// A layer that is being cleaned.
    struct Layer {
        std::array<AreaChannels, 2> halves;
        AreaChannels changes;
    };
    std::vector<Regressions> regressions;  // of each centre
    std::vector<Layer> layers;
};

namespace {

// A pixel that is like none of those around it stays what it is: so much it weighs itself, with centres at each pixel.
constexpr float own_weight = 1.125f;

/// Work of an area.
class AreaCleaning {
public:
    AreaCleaning(const Noisy& noisy, Place core, AreaScratch& scratch)
        : picture_(noisy.picture),
          noisy_(noisy),
          core_(core),
          area_{core.x - std::int64_t{rim}, core.y - std::int64_t{rim}},
          scratch_(scratch) {}

    CleanArea clean() {
        place_centres();
        const SumChanges of_sum = change_sum();
        Choice choice = choose(noisy_.guide, area_, of_sum);
        take_choice(choice);
        CleanArea area{core_, core_width(), core_height(), {}, {}, {}, {}};
        each_of_core([&](std::size_t, std::size_t x, std::size_t y) {
            area.expected.push_back(choice.expected[y * area_side + x]);
        });
        scratch_.layers.resize(std::max<std::size_t>(1, picture_.layers.size()));
        for (std::size_t l = 0; l < scratch_.layers.size(); ++l) take_layer(l, scratch_.layers[l]);
        change_layers();
        for (std::size_t l = 0; l < scratch_.layers.size(); ++l)
            area.layers.push_back(cleaned(pixels_of(l), scratch_.layers[l].changes));
        if (noisy_.guide.halves) note_moves(of_sum, choice, area);
        return area;
    }

private:
    std::uint32_t core_width() const { return CoreAxis(picture_.width, picture_.x).pixels_from(core_.x); }
    std::uint32_t core_height() const { return CoreAxis(picture_.height, picture_.y).pixels_from(core_.y); }

    // Calls action(pixel, x, y); the last two are in the area.
    template <class Action>
    void each_of_core(const Action& action) const {
        for (std::size_t y = 0; y < core_height(); ++y)
            for (std::size_t x = 0; x < core_width(); ++x)
                action((static_cast<std::size_t>(core_.y) + y) * picture_.width + static_cast<std::size_t>(core_.x) + x,
                       rim + x, rim + y);
    }

    const std::vector<Rgb>& pixels_of(std::size_t layer) const {
        return picture_.layers.empty() ? picture_.beauty : picture_.layers[layer].pixels;
    }

    // All whose window meets the area. A crop has them where its whole picture does.
    void place_centres() {
        const std::int64_t step = noisy_.step, most = area_side + std::int64_t{reach};
        const auto first_at = [&](std::int64_t area, std::int64_t crop) {
            const std::int64_t first = std::max<std::int64_t>(0, area - std::int64_t{reach});
            return first + (step / 2 + step - (first + crop) % step) % step;
        };
        const auto x_end = std::min<std::int64_t>(picture_.width, area_.x + most),
                   y_end = std::min<std::int64_t>(picture_.height, area_.y + most);
        for (auto y = first_at(area_.y, picture_.y); y < y_end; y += step)
            for (auto x = first_at(area_.x, picture_.x); x < x_end; x += step) centres_.push_back({{x, y}});
        if (centres_.empty() && x_end > 0) centres_.push_back({{x_end - 1, y_end - 1}});  // of a few pixels
        scratch_.regressions.resize(centres_.size());
    }

    // Makes the regressions, too, and what all weights of a pixel add up to.
    SumChanges change_sum() {
        SumChanges changes;
        const auto halves = halves_of_sum();
        for (auto& of_half : weights_)
            for (auto& of_filter : of_half) of_filter.assign(AreaChannels::size, 0);
        Wanted wanted;
        for_filters([&](std::size_t half, std::size_t f) { wanted[half][f].changes = &changes[half][f]; });
        for (std::size_t i = 0; i < centres_.size(); ++i) {
            regress(noisy_.guide, centres_[i], scratch_.regressions[i]);
            for_filters([&](std::size_t half, std::size_t f) {
                add_weights(centres_[i], scratch_.regressions[i][half][f], 1, area_, weights_[half][f].data());
            });
            add_changes(noisy_.guide, centres_[i], scratch_.regressions[i], halves, area_, wanted);
        }
        for_filters([&](std::size_t half, std::size_t f) {
            for (std::size_t i = 0; i < AreaChannels::size; ++i) {
                float& weight = weights_[half][f][i];
                weight = 1 / (weight + own());
                for (std::size_t c = 0; c < 3; ++c) changes[half][f].of(c)[i] *= weight;
            }
        });
        return changes;
    }
    template <class Action>
    static void for_filters(const Action& action) {
        for (const std::size_t half : {0, 1})
            for (std::size_t f = 0; f < filters; ++f) action(half, f);
    }

    std::array<AreaChannels, 2> halves_of_sum() const {
        std::array<AreaChannels, 2> halves;
        constexpr auto r = std::int64_t{halo};
        for (const std::size_t half : {0, 1})
            for (std::size_t c = 0; c < 3; ++c)
                for (std::int64_t y = -r; y < std::int64_t{area_side} + r; ++y)
                    std::copy_n(noisy_.guide.half[half][c].at(area_.x - r, area_.y + y), AreaChannels::stride,
                                halves[half].of(c) + AreaChannels::index(-r, y));
        return halves;
    }

    // A regression that is not chosen is none; its window is left as it is. Whoever gives light away is then among
    // those who get it: what a regression changes adds up to 0 over its window.
    void take_choice(const Choice& choice) {
        const auto serves = [](std::int64_t centre, std::int64_t core) {
            return centre >= core - std::int64_t{reach} && centre < core + std::int64_t{core_side + reach};
        };
        for (auto& of_half : weights_) of_half[0].assign(AreaChannels::size, 0);
        parts_.resize(centres_.size());
        for (std::size_t i = 0; i < centres_.size(); ++i) {
            const Place at = centres_[i].at;
            if (!serves(at.x, core_.x) || !serves(at.y, core_.y)) continue;
            float left = 1;
            for (std::size_t f = 0; f < filters; ++f) {
                parts_[i][f] = choice.parts[f][std::size_t((at.y - area_.y) * area_side + at.x - area_.x)];
                left -= parts_[i][f];
            }
            for_filters([&](std::size_t half, std::size_t f) {
                const float part = parts_[i][f] + (f + 1 == filters ? left : 0);
                if (part > 0)
                    add_weights(centres_[i], scratch_.regressions[i][half][f], part, area_, weights_[half][0].data());
            });
        }
        for (auto& of_half : weights_)
            for (float& weight : of_half[0]) weight = 0.5f / (weight + own());
    }
    float own() const { return own_weight / static_cast<float>(noisy_.step * noisy_.step); }

    // What is beyond the picture, or not finite, counts as black.
    void take_layer(std::size_t layer, AreaScratch::Layer& taken) const {
        auto& halves = taken.halves;
        for (AreaChannels* const channels : {&halves[0], &halves[1], &taken.changes}) channels->blacken();
        constexpr auto r = std::int64_t{halo};
        const auto x_first = std::max<std::int64_t>(0, area_.x - r),
                   x_end = std::min<std::int64_t>(picture_.width, area_.x + area_side + r),
                   y_end = std::min<std::int64_t>(picture_.height, area_.y + area_side + r);
        for (auto y = std::max<std::int64_t>(0, area_.y - r); y < y_end; ++y) {
            const auto pixel = static_cast<std::size_t>(y) * picture_.width + static_cast<std::size_t>(x_first);
            const Rgb* const all = pixels_of(layer).data() + pixel;
            const Rgb* const second = noisy_.halves.empty() ? nullptr : noisy_.halves[layer]->pixels.data() + pixel;
            const std::size_t to = AreaChannels::index(x_first - area_.x, y - area_.y);
            float *const r0 = halves[0].of(0) + to, *const g0 = halves[0].of(1) + to, *const b0 = halves[0].of(2) + to;
            float *const r1 = halves[1].of(0) + to, *const g1 = halves[1].of(1) + to, *const b1 = halves[1].of(2) + to;
            for (std::size_t x = 0; x < static_cast<std::size_t>(x_end - x_first); ++x) {
                const Rgb half = second ? second[x] : 0.5f * all[x], one = 2 * (all[x] - half), other = 2 * half;
                if (finite(one)) r0[x] = one.r, g0[x] = one.g, b0[x] = one.b;
                if (finite(other)) r1[x] = other.r, g1[x] = other.g, b1[x] = other.b;
            }
        }
    }

    // A row of centres for all layers, then the next one: regressions are brought from afar only once.
    void change_layers() {
        for (std::size_t first = 0, last = 0; first < centres_.size(); first = last) {
            while (last < centres_.size() && centres_[last].at.y == centres_[first].at.y) ++last;
            for (auto& layer : scratch_.layers)
                for (std::size_t i = first; i < last; ++i) {
                    Wanted wanted;
                    for_filters([&](std::size_t half, std::size_t f) {
                        if (parts_[i][f] > 0)
                            wanted[half][f] = {&layer.changes, weights_[half][0].data(), parts_[i][f]};
                    });
                    add_changes(noisy_.guide, centres_[i], scratch_.regressions[i], layer.halves, area_, wanted);
                }
        }
    }

    std::vector<Rgb> cleaned(const std::vector<Rgb>& pixels, const AreaChannels& changes) const {
        std::vector<Rgb> clean;
        clean.reserve(std::size_t{core_width()} * core_height());
        each_of_core([&](std::size_t pixel, std::size_t x, std::size_t y) {
            const auto i = AreaChannels::index(std::int64_t(x), std::int64_t(y));
            const Rgb value = pixels[pixel];
            clean.push_back(
                {lit(value.r, changes.of(0)[i]), lit(value.g, changes.of(1)[i]), lit(value.b, changes.of(2)[i])});
        });
        return clean;
    }

    void note_moves(const SumChanges& of_sum, const Choice& choice, CleanArea& area) const {
        area.moved = Moved(picture_, core_, area.width, area.height, area.layers.size());
        area.brightness.resize(std::size_t{area.width} * area.height);
        for (std::size_t y = 0; y < area.height; ++y) {
            note_row_of_sum(of_sum, choice, y, area.moved);
            note_row_of_layers(y, area);
        }
    }
    // By what was chosen pixel by pixel, which is nearly what was done.
    void note_row_of_sum(const SumChanges& of_sum, const Choice& choice, std::size_t y, Moved& moved) const {
        const Place left{core_.x, core_.y + std::int64_t(y)};
        const float* const parts[filters] = {choice.parts[0].data() + (rim + y) * area_side + rim,
                                             choice.parts[1].data() + (rim + y) * area_side + rim};
        const std::size_t at = AreaChannels::index(rim, std::int64_t(rim + y));
        for (std::size_t c = 0; c < 3; ++c) {
            const float *const first = noisy_.guide.half[0][c].at(left.x, left.y), *const second =
                                                                                       noisy_.guide.half[1][c].at(
                                                                                           left.x, left.y);
            moved.add_row(Moved::apart_of(c), left, core_width(), [=](auto x) { return first[x] - second[x]; });
            for (const std::size_t half : {0, 1}) {
                const float *const strict = of_sum[half][0].of(c) + at, *const lax = of_sum[half][1].of(c) + at;
                moved.add_row(Moved::change_of(half, c), left, core_width(),
                              [=](auto x) { return parts[0][x] * strict[x] + parts[1][x] * lax[x]; });
            }
        }
    }
    void note_row_of_layers(std::size_t y, CleanArea& area) const {
        const Place left{core_.x, core_.y + std::int64_t(y)};
        float* const bright = area.brightness.data() + y * area.width;
        for (std::size_t l = 0; l < area.layers.size(); ++l) {
            const Rgb* const clean = area.layers[l].data() + y * area.width;
            const Rgb* const noisy = pixels_of(l).data() + static_cast<std::size_t>(left.y) * picture_.width +
                                     static_cast<std::size_t>(left.x);
            for (std::size_t x = 0; x < area.width; ++x) bright[x] += sound(clean[x].r + clean[x].g + clean[x].b);
            const auto add = [&](std::size_t c, float Rgb::*channel) {
                area.moved.add_row(Moved::lost_of(l, c), left, area.width,
                                   [=](auto x) { return sound(noisy[x].*channel - clean[x].*channel); });
            };
            add(0, &Rgb::r), add(1, &Rgb::g), add(2, &Rgb::b);
        }
        for (std::size_t x = 0; x < area.width; ++x) bright[x] = std::max(0.0f, bright[x] / 3) + dim;
        area.moved.add_row(Moved::brightness, left, area.width, [=](auto x) { return bright[x]; });
    }

    const Picture& picture_;
    const Noisy& noisy_;
    Place core_, area_;
    std::vector<Centre> centres_;
    std::vector<std::array<float, filters>> parts_;  // of each centre: what is chosen
    AreaScratch& scratch_;
    // By half and filter: what the weights of a pixel are in all; in the end, by half, what changes count in all.
    std::array<std::array<std::vector<float>, filters>, 2> weights_{};
};

}  // namespace

AreaCleaner::AreaCleaner(const Noisy& noisy) : noisy_(noisy) {}
AreaCleaner::~AreaCleaner() = default;

std::unique_ptr<AreaScratch> AreaCleaner::idle_scratch() {
    const std::lock_guard lock(idle_mutex_);
    if (idle_.empty()) return std::make_unique<AreaScratch>();
    auto scratch = std::move(idle_.back());
    idle_.pop_back();
    return scratch;
}

CleanArea AreaCleaner::clean(Place core) {
    auto scratch = idle_scratch();
    CleanArea area = AreaCleaning(noisy_, core, *scratch).clean();
    const std::lock_guard lock(idle_mutex_);
    idle_.push_back(std::move(scratch));
    return area;
}

}  // namespace lightnet::cleaning
