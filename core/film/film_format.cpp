#include "core/film/film_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/base/error.hpp"
#include "core/film/clean_layers.hpp"

namespace lightnet {

std::size_t FilmFormat::first_colour(std::size_t beside) const {
    std::size_t colour = layers.size();
    for (std::size_t i = 0; i < beside; ++i) colour += width_of(shown[i]);
    return colour;
}

std::size_t FilmFormat::width_of(const std::string& name) const {
    const auto kept = ids.find(name);
    return kept == ids.end() ? 1 : kept->second;
}

const std::string& FilmFormat::name_of(std::size_t colour) const {
    static const std::string alpha_name = "A";
    if (colour < layers.size()) return layers[colour];
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (colour < first_colour(i + 1)) return shown[i];
    return alpha_name;
}

bool FilmFormat::is_light(std::size_t colour) const {
    if (alpha && colour + 1 == colours()) return false;
    return colour < layers.size() || !facts.contains(name_of(colour));
}

bool FilmFormat::is_plain(std::size_t colour) const {
    return !(alpha && colour + 1 == colours()) && !ids.contains(name_of(colour));
}

bool FilmFormat::halves() const {
    return std::any_of(shown.begin(), shown.end(), [](const auto& name) { return cleaning::is_half(name); });
}

std::vector<std::size_t> FilmFormat::views() const {
    std::vector<std::size_t> colours(layers.size());
    std::iota(colours.begin(), colours.end(), std::size_t{0});
    for (std::size_t i = 0; i < shown.size() + alpha; ++i) colours.push_back(first_colour(i));
    return colours;
}

Addition FilmFormat::addition() const {
    std::vector<IdColours> of_ids;
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (ids.contains(shown[i])) of_ids.push_back({first_colour(i), width_of(shown[i])});
    return {colours(), std::move(of_ids)};
}

void expect_sound(const FilmFormat& format) {
    const std::uint32_t width = format.width, height = format.height;
    const auto& layers = format.layers;
    if (!width || !height) throw Error("film", "a picture needs at least one pixel");
    if (!format.samples) throw Error("film", "a picture needs at least one sample per pixel");
    if (layers.empty()) throw Error("film", "a picture needs at least one layer");
    std::set<std::string> names(layers.begin(), layers.end());
    names.insert(format.shown.begin(), format.shown.end());
    if (names.size() != layers.size() + format.shown.size()) throw Error("film", "two layers have the same name");
    for (const auto& [matte, count] : format.ids)
        for (std::uint32_t level = 0; 2 * level < count; ++level)
            if (const auto name = fmt::format("{}{:02}", matte, level); !names.insert(name).second)
                throw Error("film", "a layer is called '" + name + "', as one of the matte '" + matte + "'");
    const auto lies_within = [](std::uint32_t from, std::uint32_t size, std::uint32_t side) {
        return size > 0 && from < side && size <= side - from;
    };
    if (const auto& crop = format.crop;
        crop && !(lies_within(crop->x, crop->width, width) && lies_within(crop->y, crop->height, height)))
        throw Error("film", "the crop is not inside of the picture");
}

}  // namespace lightnet
