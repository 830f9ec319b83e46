#include "core/film/clean/clean.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/film/clean/area.hpp"
#include "core/film/clean/guide.hpp"
#include "core/film/clean/pieces.hpp"
#include "core/film/clean/returned.hpp"
#include "core/film/clean_layers.hpp"

namespace lightnet {
namespace {

using cleaning::CleanArea;
using cleaning::Guide;
using cleaning::Moved;
using cleaning::Noisy;

// Of each layer; none, where some have none.
std::vector<const PictureLayer*> halves_of(const Picture& picture) {
    std::vector<const PictureLayer*> halves;
    for (const auto& layer : picture.layers)
        for (const auto& shown : picture.shown)
            if (shown.name == cleaning::half_of(layer.name)) halves.push_back(&shown);
    if (halves.size() != picture.layers.size()) halves.clear();
    return halves;
}

// What was only there for cleaning.
void drop_what_is_used_up(Picture& picture) {
    std::erase_if(picture.shown, [](const auto& layer) { return cleaning::is_for_cleaning(layer.name); });
}

// For the header of its file: what was done, and by what.
std::string words_for(const Noisy& noisy) {
    return fmt::format(
        "first-order regressions of all layers with the same weights, by {} and {} features, every {} pixels; "
        "neighbours up to {} pixels away, alike within {} and {} deviations of the noise{}",
        noisy.guide.halves ? "halves of the samples" : "noise that neighbours tell of", noisy.guide.features.size(),
        noisy.step, cleaning::reach, cleaning::tolerance[0], cleaning::tolerance[1],
        noisy.guide.halves ? fmt::format("; what cells of {0} x {0} pixels lost is returned", cleaning::cell_side)
                           : "");
}

// Over more pixels than choices are made by, as the product of two halves' changes is nearly all noise. Of what it says
// beyond the noise that was left, as much counts as is likely to be there (James and Stein's way).
PictureLayer error_layer(const std::vector<cleaning::SquaredError>& expected, std::uint32_t width,
                         std::uint32_t height) {
    constexpr std::uint32_t radius = 12;
    // Weights for one half come from the other, so that what is left of their noise has something in common: measured
    // on four scenes (docs/clean.md) with 4 to 128 samples.
    constexpr float untold = 1.2f;
    constexpr float pixels = (2 * radius + 1) * (2 * radius + 1);
    const auto smooth = [&](float cleaning::SquaredError::*part) {
        return cleaning::smoothed(width, height, radius, [&](std::int64_t y, float* row) {
            for (std::size_t x = 0; x < width; ++x) row[x] = expected[static_cast<std::size_t>(y) * width + x].*part;
            return row;
        });
    };
    const auto all = smooth(&cleaning::SquaredError::all), variance = smooth(&cleaning::SquaredError::variance),
               spread = smooth(&cleaning::SquaredError::spread);
    PictureLayer layer{clean_error, {}};
    layer.pixels.reserve(expected.size());
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const float noise = *variance.at(x, y), rest = std::max(0.0f, *all.at(x, y) - noise);
            const float likely = std::max(0.0f, 1 - *spread.at(x, y) / (pixels * rest * rest + 1e-20f));
            const float error = untold * std::sqrt(noise + likely * rest);
            layer.pixels.push_back({error, error, error});
        }
    return layer;
}

std::vector<std::string> lacks_of(const Picture& noisy, const Guide& guide) {
    std::vector<std::string> lacks;
    if (noisy.whole_width)
        lacks.emplace_back(
            fmt::format("it is a crop: up to {} pixels from its border it is not what the whole picture would be there",
                        cleaning::influence + cleaning::return_reach));
    if (!guide.halves) lacks.emplace_back("its samples are not in two halves, so its noise is guessed from neighbours");
    if (guide.features.empty())
        lacks.emplace_back("it says nothing of surfaces (albedo, normal, depth), so edges and textures may blur");
    return lacks;
}

// So many areas that all cores are busy, and few enough for what is clean of them to be held beside the picture.
constexpr std::size_t areas_at_once = 16;

/// What is known of the whole picture when its areas are clean.
struct Found {
    std::vector<cleaning::SquaredError> expected;
    std::vector<float> brightness;
    Moved moved;
};

void put_into(Picture& picture, Found& found, const CleanArea& area) {
    found.moved.add(area.moved);
    for (std::size_t y = 0; y < area.height; ++y) {
        const std::size_t from = y * area.width, to = (static_cast<std::size_t>(area.place.y) + y) * picture.width +
                                                      static_cast<std::size_t>(area.place.x);
        std::copy_n(area.expected.begin() + from, area.width, found.expected.begin() + to);
        if (!area.brightness.empty())
            std::copy_n(area.brightness.begin() + from, area.width, found.brightness.begin() + to);
        for (std::size_t l = 0; l < area.layers.size(); ++l)
            std::copy_n(area.layers[l].begin() + from, area.width,
                        (picture.layers.empty() ? picture.beauty : picture.layers[l].pixels).begin() + to);
    }
}

// In place, some rows of areas after the others: pixels are still noisy when the rows below look at them.
std::vector<cleaning::SquaredError> clean_areas(Picture& picture, const Noisy& noisy) {
    const std::size_t pixels = std::size_t{picture.width} * picture.height;
    Found found{std::vector<cleaning::SquaredError>(pixels), std::vector<float>(pixels),
                Moved(picture, {}, picture.width, picture.height, std::max<std::size_t>(1, picture.layers.size()))};
    const cleaning::CoreAxis columns(picture.width, picture.x), lines(picture.height, picture.y);
    const std::size_t across = columns.cores(), down = lines.cores();
    const std::size_t rows = (areas_at_once + across - 1) / across;
    static_assert(cleaning::core_side > cleaning::rim + cleaning::halo, "areas look no further than the next row");
    cleaning::AreaCleaner cleaner(noisy);
    std::vector<CleanArea> last;
    for (std::size_t row = 0; row < down; row += rows) {
        std::vector<CleanArea> now(std::min(rows, down - row) * across);
        cleaning::in_large_pieces(
            now.size(),
            [&](std::size_t first, std::size_t end) {
                for (std::size_t i = first; i < end; ++i)
                    now[i] = cleaner.clean({columns.first(i % across), lines.first(row + i / across)});
            },
            1);
        for (const auto& area : last) put_into(picture, found, area);
        last = std::move(now);
    }
    for (const auto& area : last) put_into(picture, found, area);
    if (noisy.guide.halves) return_light(std::move(found.moved), found.brightness, picture);
    return std::move(found.expected);
}

std::uint32_t pixels_between_centres(CleanQuality quality) {
    return quality == CleanQuality::draft ? 8 : quality == CleanQuality::usual ? 4 : 2;
}

}  // namespace

// DECISIONS: one-set-of-weights
// DECISIONS: fitted-at-centres
Cleaned clean(Picture picture, CleanQuality quality) {
    Cleaned cleaned{std::move(picture), {}};
    Picture& noisy = cleaned.picture;
    if (!noisy.layers.empty()) noisy.beauty = {};  // it is made anew
    noisy.overflowed = 0;
    Guide guide = cleaning::take_guide(noisy);
    const auto halves = guide.halves ? halves_of(noisy) : std::vector<const PictureLayer*>{};
    const Noisy work{noisy, halves, std::move(guide), pixels_between_centres(quality)};
    cleaned.lacks = lacks_of(noisy, work.guide);
    const auto expected = clean_areas(noisy, work);
    drop_what_is_used_up(noisy);
    if (work.guide.halves) noisy.shown.push_back(error_layer(expected, noisy.width, noisy.height));
    noisy.notes.texts[cleaned_note] = words_for(work);
    if (!noisy.layers.empty()) blacken_overflow(noisy);
    return cleaned;
}

}  // namespace lightnet
