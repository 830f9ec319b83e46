#include "core/film/clean/clean.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/film/clean/area.hpp"
#include "core/film/clean/guide.hpp"
#include "core/film/clean/pair_weights.hpp"
#include "core/film/clean/pieces.hpp"
#include "core/film/clean_layers.hpp"

namespace lightnet {
namespace {

using cleaning::Guide;

// Of each layer; none, where some have none.
std::vector<const PictureLayer*> halves_of(const Picture& picture) {
    std::vector<const PictureLayer*> halves;
    for (const auto& layer : picture.layers)
        for (const auto& shown : picture.shown)
            if (shown.name == cleaning::half_of(layer.name)) halves.push_back(&shown);
    if (halves.size() != picture.layers.size()) halves.clear();
    return halves;
}

// All but pixels that are made anew.
Picture frame_of(const Picture& noisy) {
    Picture clean{noisy.width, noisy.height, {}, {}, noisy.x, noisy.y, noisy.whole_width, noisy.whole_height};
    clean.samples = noisy.samples, clean.mattes = noisy.mattes, clean.alpha = noisy.alpha;
    clean.notes = noisy.notes, clean.storage = noisy.storage, clean.done = noisy.done;
    for (const auto& layer : noisy.shown)
        if (!cleaning::is_for_cleaning(layer.name)) clean.shown.push_back(layer);
    for (const auto& layer : noisy.layers)
        clean.layers.push_back({layer.name, std::vector<Rgb>(layer.pixels.size()), layer.gain});
    if (clean.layers.empty()) clean.beauty.resize(noisy.beauty.size());
    return clean;
}

// For the header of its file: what was done, and by what.
std::string words_for(const Guide& guide) {
    return fmt::format(
        "first-order regression of all layers with the same weights, by {} and {} features; neighbours up to {} pixels "
        "away, alike within {} and {} deviations of the noise",
        guide.halves ? "halves of the samples" : "noise that neighbours tell of", guide.features.size(),
        cleaning::reach, cleaning::tolerance[0], cleaning::tolerance[1]);
}

// Over more pixels than choices are made by: the product of two halves' changes is nearly all noise.
PictureLayer error_layer(const std::vector<cleaning::SquaredError>& expected, std::uint32_t width,
                         std::uint32_t height) {
    constexpr std::uint32_t radius = 12;
    cleaning::Sheet all(width, height), variance(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const auto& found = expected[std::size_t{y} * width + x];
            *all.at(x, y) = found.all, *variance.at(x, y) = found.variance;
        }
    all = cleaning::smoothed(all, width, height, radius),
    variance = cleaning::smoothed(variance, width, height, radius);
    PictureLayer layer{"clean_error", {}};
    layer.pixels.reserve(expected.size());
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const float error = std::sqrt(std::max(*variance.at(x, y), *all.at(x, y)));
            layer.pixels.push_back({error, error, error});
        }
    return layer;
}

std::vector<std::string> lacks_of(const Guide& guide) {
    std::vector<std::string> lacks;
    if (!guide.halves) lacks.emplace_back("its samples are not in two halves, so its noise is guessed from neighbours");
    if (guide.features.empty())
        lacks.emplace_back("it says nothing of surfaces (albedo, normal, depth), so edges and textures may blur");
    return lacks;
}

}  // namespace

// DECISIONS: one-set-of-weights
Cleaned clean(const Picture& noisy) {
    Cleaned cleaned{frame_of(noisy), {}};
    const Guide guide = cleaning::guide_of(noisy);
    cleaned.lacks = lacks_of(guide);
    const auto halves = guide.halves ? halves_of(noisy) : std::vector<const PictureLayer*>{};
    std::vector<cleaning::SquaredError> expected(noisy.beauty.size());
    const std::size_t across = (noisy.width + cleaning::core_side - 1) / cleaning::core_side;
    const std::size_t down = (noisy.height + cleaning::core_side - 1) / cleaning::core_side;
    cleaning::in_large_pieces(
        across * down,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                cleaning::clean_area(
                    noisy, halves, guide,
                    {std::int64_t(i % across * cleaning::core_side), std::int64_t(i / across * cleaning::core_side)},
                    cleaned.picture, expected);
        },
        1);
    if (guide.halves) cleaned.picture.shown.push_back(error_layer(expected, noisy.width, noisy.height));
    cleaned.picture.notes.texts[cleaned_note] = words_for(guide);
    if (!cleaned.picture.layers.empty()) blacken_overflow(cleaned.picture);
    return cleaned;
}

}  // namespace lightnet
