// The picture of a film.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/film/film.hpp"
#include "core/film/film_shown.hpp"

namespace lightnet {
namespace {

PictureMatte matte_of(const std::string& name, std::uint32_t ids, std::size_t pixels) {
    PictureMatte matte{name, ids + ids % 2, {}, {}};
    matte.pixels.resize(pixels * matte.ranks);
    return matte;
}

// What is no part of the sum. `from`: where on the film each pixel is.
void add_beside(Picture& picture, const FilmFormat& format, const FilmShown& all, std::span<const std::size_t> from,
                float scale) {
    const std::size_t colours = format.colours();
    const auto mean = [&](std::size_t i, std::size_t colour) {
        const auto samples = all.samples[from[i]];
        return samples ? all.sums[from[i] * colours + colour] / static_cast<float>(samples) : Rgb{};
    };
    for (std::size_t s = 0; s < format.shown.size(); ++s) {
        const auto& name = format.shown[s];
        const std::size_t first = format.first_colour(s);
        if (const auto ids = format.ids.find(name); ids != format.ids.end()) {
            auto& matte = picture.mattes.emplace_back(matte_of(name, ids->second, from.size()));
            for (std::size_t i = 0; i < from.size(); ++i)
                for (std::uint32_t rank = 0; rank < ids->second; ++rank)
                    matte.pixels[i * matte.ranks + rank] = {all.sums[from[i] * colours + first + rank].r,
                                                            mean(i, first + rank).g};
            continue;
        }
        auto& layer = picture.shown.emplace_back(PictureLayer{name, std::vector<Rgb>(from.size())});
        if (const auto own = format.letters.find(name); own != format.letters.end()) layer.letters = own->second;
        const float exposed = format.is_light(first) ? scale : 1;
        for (std::size_t i = 0; i < from.size(); ++i) layer.pixels[i] = mean(i, first) * exposed;
        if (may_be_half(picture.storage, layer)) round_to_half(layer.pixels);
    }
    if (!format.alpha) return;
    for (std::size_t i = 0; i < from.size(); ++i) picture.alpha.push_back(mean(i, colours - 1).r);
}

// `pixel`: sums of all colours.
Rgb seen_as(const FilmFormat& format, std::size_t view, std::span<const Rgb> pixel, float samples, float scale) {
    if (samples == 0) return {};
    const auto& name = format.name_of(view);
    if (format.ids.contains(name)) return false_colour(pixel.subspan(view, format.width_of(name)), samples);
    const Rgb mean = pixel[view] / samples;
    if (!format.is_plain(view)) return {mean.r, mean.r, mean.r};
    return mean * (format.is_light(view) ? scale : 1);
}

}  // namespace

Picture Film::picture(float scale) const {
    const Window wanted = format_.crop.value_or(tiling_.window());
    const std::size_t pixels = wanted.pixels(), layers = format_.colours();
    Picture picture{wanted.width, wanted.height, {}, {}};
    picture.storage = format_.storage;
    if (format_.crop) {
        picture.x = wanted.x, picture.y = wanted.y;
        picture.whole_width = format_.width, picture.whole_height = format_.height;
    }
    picture.done = complete() ? 1 : std::min(float(done()), std::nextafter(1.0f, 0.0f));
    // What was rendered and what is wanted differ where a crop cuts cells.
    std::vector<std::size_t> from(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        from[i] = tiling_.index(wanted.x + std::uint32_t(i % wanted.width), wanted.y + std::uint32_t(i / wanted.width));
    const auto all = shown_of(tiling_, sums_, parts_, layers);
    const auto at = [&](std::size_t i) { return all.samples[from[i]]; };
    bool differ = format_.adaptive();
    for (std::size_t i = 1; i < pixels && !differ; ++i) differ = at(i) != at(0);
    if (differ)
        for (std::size_t i = 0; i < pixels; ++i) picture.samples.push_back(float(at(i)));
    for (std::size_t k = 0; k < format_.layers.size(); ++k) {
        auto& layer = picture.layers.emplace_back(PictureLayer{format_.layers[k], std::vector<Rgb>(pixels)});
        for (std::size_t i = 0; i < pixels; ++i)
            if (const auto samples = at(i))
                layer.pixels[i] = all.sums[from[i] * layers + k] / static_cast<float>(samples) * scale;
    }
    add_beside(picture, format_, all, from, scale);
    // DECISIONS: beauty-is-the-sum
    for (std::size_t k = 0; k < format_.gains.size(); ++k) picture.layers[k].gain = format_.gains[k];
    blacken_overflow(picture);
    return picture;
}

std::vector<Rgb> Film::so_far(const Tile& tile) const {
    const std::size_t colours = format_.colours();
    const auto shown = shown_of(tile, tiling_, sums_, parts_, colours);
    const auto views = format_.views();
    std::vector<Rgb> seen;
    seen.reserve(tile.pixels() * views.size());
    for (std::size_t i = 0; i < tile.pixels(); ++i)
        for (const std::size_t k : views)
            seen.push_back(seen_as(format_, k, shown.sums.subspan(i * colours, colours),
                                   static_cast<float>(shown.samples[i]), scale_));
    return seen;
}

}  // namespace lightnet
