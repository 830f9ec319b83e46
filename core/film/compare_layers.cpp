#include "core/film/compare_layers.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lightnet {
namespace {

using Layers = std::vector<const PictureLayer*>;

Layers layers_of(const Picture& picture) {
    Layers all;
    for (const auto* layers : {&picture.layers, &picture.shown})
        for (const auto& layer : *layers) all.push_back(&layer);
    return all;
}

const PictureLayer* find(const Layers& layers, const std::string& name) {
    const auto found =
        std::find_if(layers.begin(), layers.end(), [&](const auto* layer) { return layer->name == name; });
    return found == layers.end() ? nullptr : *found;
}

std::vector<std::string> names_missing_in(const Layers& others, const Layers& layers) {
    std::vector<std::string> names;
    for (const auto* layer : layers)
        if (!find(others, layer->name)) names.push_back(layer->name);
    return names;
}

bool same_order(const Layers& a, const Layers& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto* one, const auto* other) { return one->name == other->name; });
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && (a.empty() || !std::memcmp(a.data(), b.data(), a.size() * sizeof(float)));
}

std::vector<Rgb> minus(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    std::vector<Rgb> result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] - b[i];
    return result;
}

// The curve of sRGB, backwards.
float linear(float shown) { return shown <= 0.04045f ? shown / 12.92f : std::pow((shown + 0.055f) / 1.055f, 2.4f); }

// Polynomials of Matt Zucker's through the colours of matplotlib's map, to about 1 % (CC0), in the colours of sRGB.
Rgb magma(float t) {
    constexpr Rgb terms[] = {
        {-0.002136485f, -0.000749655f, -0.005386128f}, {0.251660541f, 0.677523244f, 2.494026599f},
        {8.353717279f, -3.577719515f, 0.314467903f},   {-27.66873309f, 14.26473078f, -13.64921319f},
        {52.17613981f, -27.94360607f, 12.94416944f},   {-50.76852536f, 29.04658282f, 4.234152994f},
        {18.65570507f, -11.48977352f, -5.601961509f}};
    Rgb sum;
    for (auto term = std::rbegin(terms); term != std::rend(terms); ++term) sum = sum * t + *term;
    return {linear(std::clamp(sum.r, 0.0f, 1.0f)), linear(std::clamp(sum.g, 0.0f, 1.0f)),
            linear(std::clamp(sum.b, 0.0f, 1.0f))};
}

}  // namespace

Comparison compare_layers(const Picture& reference, const Picture& picture, const FlipView& view) {
    Comparison found;
    found.layers.push_back({"beauty", compare(reference, picture), 0});
    Flip seen = flip(picture.width, reference.beauty, picture.beauty, view);
    found.layers.front().flip = seen.mean;
    found.flip_map = std::move(seen.map);
    const auto expected = layers_of(reference), got = layers_of(picture);
    for (const auto* layer : expected) {
        const auto* other = find(got, layer->name);
        if (!other) continue;
        found.layers.push_back({layer->name, compare(picture.width, layer->pixels, other->pixels),
                                flip(picture.width, layer->pixels, other->pixels, view).mean});
    }
    found.only_in_reference = names_missing_in(got, expected);
    found.only_in_picture = names_missing_in(expected, got);
    found.identical = same_order(expected, got) && same_bits(reference.samples, picture.samples) &&
                      std::all_of(found.layers.begin(), found.layers.end(),
                                  [](const auto& layer) { return layer.difference.identical; });
    return found;
}

Picture difference_of(const Picture& reference, const Picture& picture) {
    refuse_other_size(reference, picture);
    Picture result = picture;
    result.samples.clear();
    result.beauty = minus(picture.beauty, reference.beauty);
    const auto expected = layers_of(reference);
    for (auto* layers : {&result.layers, &result.shown}) {
        std::erase_if(*layers, [&](const auto& layer) { return !find(expected, layer.name); });
        for (auto& layer : *layers) layer.pixels = minus(layer.pixels, find(expected, layer.name)->pixels);
    }
    return result;
}

Picture without_signs(Picture difference) {
    for (Rgb& c : difference.beauty) c = {std::abs(c.r), std::abs(c.g), std::abs(c.b)};
    return difference;
}

Picture magma_of(std::uint32_t width, const std::vector<float>& values) {
    Picture picture{width, static_cast<std::uint32_t>(values.size() / width), {}, {}};
    for (const float value : values) picture.beauty.push_back(magma(std::clamp(value, 0.0f, 1.0f)));
    return picture;
}

}  // namespace lightnet
