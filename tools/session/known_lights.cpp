#include "tools/session/known_lights.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

std::vector<Rgb> some_of(std::span<const Rgb> pixels, std::span<const std::size_t> colours, std::size_t all) {
    std::vector<Rgb> some;
    some.reserve(pixels.size() / all * colours.size());
    for (std::size_t first = 0; first < pixels.size(); first += all)
        for (const auto colour : colours) some.push_back(pixels[first + colour]);
    return some;
}

// The reverse.
void put_some(std::span<const Rgb> some, std::span<const std::size_t> colours, std::span<Rgb> pixels, std::size_t all) {
    const Rgb* next = some.data();
    for (std::size_t first = 0; first < pixels.size(); first += all)
        for (const auto colour : colours) pixels[first + colour] = *next++;
}

// A film of so many colours and nothing else.
FilmFormat of_colours(const FilmFormat& whole, std::size_t colours) {
    FilmFormat format;
    format.width = whole.width, format.height = whole.height;
    format.samples = whole.samples, format.crop = whole.crop;
    for (std::size_t i = 0; i < colours; ++i) format.layers.push_back(std::to_string(i));
    return format;
}

bool is_whole(const FilmState& state, const FilmFormat& format) try {
    Film film(format);
    film.restore(state);
    return state.samples == format.samples && film.complete();
} catch (const Error&) {
    return false;
}

// Per pixel of the film and colour.
std::vector<Rgb> means_of(const FilmState& state, const Window& window, std::size_t colours) {
    auto means = state.sums;
    for (const auto& part : state.parts)
        for (const auto& [block, sum] : part.waiting)
            for (std::uint32_t y = 0; y < part.height; ++y) {
                const std::size_t from = std::size_t{y} * part.width * colours, count = part.width * colours;
                const std::size_t to =
                    (std::size_t{part.y - window.y + y} * window.width + part.x - window.x) * colours;
                for (std::size_t i = 0; i < count; ++i)
                    if (finite(sum.pixels[from + i])) means[to + i] += sum.pixels[from + i];
            }
    for (Rgb& mean : means) mean *= 1 / static_cast<float>(state.samples);
    return means;
}

}  // namespace

FilmState colours_of(const FilmState& film, std::span<const std::size_t> colours, std::size_t all) {
    FilmState some;
    some.samples = film.samples;
    some.sums = some_of(film.sums, colours, all);
    for (const auto colour : colours) some.lost.push_back(film.lost[colour]);
    for (const auto& part : film.parts) {
        auto& one = some.parts.emplace_back(
            FilmState::Part{part.x, part.y, part.width, part.height, part.next_block, {}, part.ended});
        for (const auto& [block, sum] : part.waiting)
            one.waiting[block] = {sum.blocks, some_of(sum.pixels, colours, all)};
    }
    return some;
}

bool KnownLights::add(const LightRecipe& recipe, FilmState state) {
    const std::size_t colours = recipe.colours.size();
    if (!is_whole(state, of_colours(format_, colours))) return false;
    auto means = means_of(state, format_.work(), colours);
    lights_.push_back({recipe, std::move(state), std::move(means)});
    return true;
}

void KnownLights::settle(const Registry& registry) {
    std::vector<SingleLight> lights;
    for (const auto& one : lights_) lights.push_back(one.recipe.light);
    rest_ = without_lights(rest_, registry, lights);
    std::erase_if(lights_, [&](const Light& one) {
        return std::none_of(lights.begin(), lights.end(),
                            [&](const SingleLight& left) { return left.node == one.recipe.light.node; });
    });
}

std::vector<std::string> KnownLights::names() const {
    std::vector<std::string> names;
    for (const auto& one : lights_)
        for (const auto layer : one.recipe.light.layers) names.push_back(format_.layers[layer]);
    return names;
}

std::vector<Rgb> KnownLights::shown_in(const Tile& tile, std::span<const Rgb> pixels) const {
    std::vector<Rgb> shown(pixels.begin(), pixels.end());
    const Window window = format_.work();
    const std::size_t all = format_.colours();
    for (const auto& [recipe, state, means] : lights_) {
        const auto& colours = recipe.colours;
        std::size_t to = 0;
        for (std::uint32_t y = 0; y < tile.height; y += tile.step())
            for (std::uint32_t x = 0; x < tile.width; x += tile.step(), to += all) {
                const std::size_t from =
                    (std::size_t{tile.y - window.y + y} * window.width + tile.x - window.x + x) * colours.size();
                for (std::size_t k = 0; k < colours.size(); ++k)
                    shown[to + colours[k]] = means[from + k] * static_cast<float>(tile.samples);
            }
    }
    return shown;
}

void KnownLights::complete(Film& incomplete) {
    if (!are_shown()) return;
    FilmState film = incomplete.state();
    const std::size_t all = format_.colours();
    for (const auto& [recipe, state, means] : lights_) {
        put_some(state.sums, recipe.colours, film.sums, all);
        for (std::size_t k = 0; k < recipe.colours.size(); ++k) film.lost[recipe.colours[k]] = state.lost[k];
        for (auto& part : film.parts) {
            const auto known = std::find_if(state.parts.begin(), state.parts.end(), [&](const auto& one) {
                return one.x == part.x && one.y == part.y && one.width == part.width && one.height == part.height;
            });
            if (known == state.parts.end() || known->next_block != part.next_block ||
                known->waiting.size() != part.waiting.size())
                throw Error("film", "layers that are known were cut in another way");
            for (auto& [block, sum] : part.waiting)
                put_some(known->waiting.at(block).pixels, recipe.colours, sum.pixels, all);
        }
    }
    Film whole(incomplete.format());
    whole.expose(incomplete.scale());
    whole.restore(std::move(film));
    incomplete = std::move(whole);
    completed_ = true;
}

}  // namespace lightnet
