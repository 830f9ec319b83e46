#include "core/film/clean/area.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/film/clean/changes.hpp"

namespace lightnet::cleaning {
namespace {

// A pixel that is like none of those around it stays what it is: so much it weighs itself, with centres at each pixel.
constexpr float own_weight = 1.125f;

/// A layer that is being cleaned.
struct LayerWork {
    std::array<AreaChannels, 2> halves;
    AreaChannels changes;
};

/// Work of an area.
class AreaCleaning {
public:
    AreaCleaning(const Noisy& noisy, Place core)
        : picture_(noisy.picture),
          noisy_(noisy),
          core_(core),
          area_{core.x - std::int64_t{rim}, core.y - std::int64_t{rim}} {}

    CleanArea clean() {
        place_centres();
        const SumChanges of_sum = change_sum();
        Choice choice = choose(noisy_.guide, area_, of_sum);
        take_choice(choice);
        CleanArea area{core_, core_width(), core_height(), {}, {}, {}, {}};
        each_of_core([&](std::size_t, std::size_t x, std::size_t y) {
            area.expected.push_back(choice.expected[y * area_side + x]);
        });
        std::vector<LayerWork> work(std::max<std::size_t>(1, picture_.layers.size()));
        for (std::size_t l = 0; l < work.size(); ++l) take_layer(l, work[l].halves);
        change_layers(work);
        for (std::size_t l = 0; l < work.size(); ++l) area.layers.push_back(cleaned(pixels_of(l), work[l].changes));
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
        regressions_.resize(centres_.size());
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
            regress(noisy_.guide, centres_[i], regressions_[i]);
            for_filters([&](std::size_t half, std::size_t f) {
                add_weights(centres_[i], regressions_[i][half][f], 1, area_, weights_[half][f].data());
            });
            add_changes(noisy_.guide, centres_[i], regressions_[i], halves, area_, wanted);
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
                if (part > 0) add_weights(centres_[i], regressions_[i][half][f], part, area_, weights_[half][0].data());
            });
        }
        for (auto& of_half : weights_)
            for (float& weight : of_half[0]) weight = 0.5f / (weight + own());
    }
    float own() const { return own_weight / static_cast<float>(noisy_.step * noisy_.step); }

    // What is beyond the picture, or not finite, counts as black.
    void take_layer(std::size_t layer, std::array<AreaChannels, 2>& halves) const {
        constexpr auto r = std::int64_t{halo};
        const auto& all = pixels_of(layer);
        const auto x_first = std::max<std::int64_t>(0, area_.x - r),
                   x_end = std::min<std::int64_t>(picture_.width, area_.x + area_side + r),
                   y_end = std::min<std::int64_t>(picture_.height, area_.y + area_side + r);
        for (auto y = std::max<std::int64_t>(0, area_.y - r); y < y_end; ++y)
            for (auto x = x_first; x < x_end; ++x) {
                const auto pixel = static_cast<std::size_t>(y) * picture_.width + static_cast<std::size_t>(x);
                const Rgb second = noisy_.halves.empty() ? 0.5f * all[pixel] : noisy_.halves[layer]->pixels[pixel];
                put_pixel(halves[0], x, y, 2 * (all[pixel] - second));
                put_pixel(halves[1], x, y, 2 * second);
            }
    }
    void put_pixel(AreaChannels& channels, std::int64_t x, std::int64_t y, const Rgb& value) const {
        if (!finite(value)) return;
        const auto i = AreaChannels::index(x - area_.x, y - area_.y);
        channels.of(0)[i] = value.r, channels.of(1)[i] = value.g, channels.of(2)[i] = value.b;
    }

    // A row of centres for all layers, then the next one: regressions are brought from afar only once.
    void change_layers(std::vector<LayerWork>& work) const {
        for (std::size_t first = 0, last = 0; first < centres_.size(); first = last) {
            while (last < centres_.size() && centres_[last].at.y == centres_[first].at.y) ++last;
            for (auto& layer : work)
                for (std::size_t i = first; i < last; ++i) {
                    Wanted wanted;
                    for_filters([&](std::size_t half, std::size_t f) {
                        if (parts_[i][f] > 0)
                            wanted[half][f] = {&layer.changes, weights_[half][0].data(), parts_[i][f]};
                    });
                    add_changes(noisy_.guide, centres_[i], regressions_[i], layer.halves, area_, wanted);
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

    // Of the sum by what was chosen pixel by pixel, which is nearly what was done.
    void note_moves(const SumChanges& of_sum, const Choice& choice, CleanArea& area) const {
        Moved moved(picture_, core_, core_width(), core_height(), area.layers.size());
        std::size_t next = 0;
        each_of_core([&](std::size_t pixel, std::size_t x, std::size_t y) {
            const Place at{area_.x + std::int64_t(x), area_.y + std::int64_t(y)};
            const std::size_t cell = moved.grid.cell_of(at.x, at.y), i = y * area_side + x,
                              in_area = AreaChannels::index(std::int64_t(x), std::int64_t(y));
            for (std::size_t c = 0; c < 3; ++c) {
                moved.planes[Moved::apart_of(c)][cell] +=
                    *noisy_.guide.half[0][c].at(at.x, at.y) - *noisy_.guide.half[1][c].at(at.x, at.y);
                for_filters([&](std::size_t half, std::size_t f) {
                    moved.planes[Moved::change_of(half, c)][cell] +=
                        choice.parts[f][i] * of_sum[half][f].of(c)[in_area];
                });
            }
            float bright = 0;
            for (std::size_t l = 0; l < area.layers.size(); ++l) {
                const Rgb clean = area.layers[l][next], lost = pixels_of(l)[pixel] - clean;
                bright += sound(clean.r + clean.g + clean.b);
                moved.planes[Moved::lost_of(l, 0)][cell] += sound(lost.r);
                moved.planes[Moved::lost_of(l, 1)][cell] += sound(lost.g);
                moved.planes[Moved::lost_of(l, 2)][cell] += sound(lost.b);
            }
            area.brightness.push_back(std::max(0.0f, bright / 3) + dim);
            moved.planes[Moved::brightness][cell] += area.brightness.back();
            ++next;
        });
        area.moved = std::move(moved);
    }

    const Picture& picture_;
    const Noisy& noisy_;
    Place core_, area_;
    std::vector<Centre> centres_;
    std::vector<Regressions> regressions_;           // of each centre
    std::vector<std::array<float, filters>> parts_;  // of each centre: what is chosen
    // By half and filter: what the weights of a pixel are in all; in the end, by half, what changes count in all.
    std::array<std::array<std::vector<float>, filters>, 2> weights_{};
};

}  // namespace

CleanArea clean_area(const Noisy& noisy, Place core) { return AreaCleaning(noisy, core).clean(); }

}  // namespace lightnet::cleaning
