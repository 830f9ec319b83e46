#include "tools/watch/viewed_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
#include <thread>
#include <utility>

#include "core/base/error.hpp"
#include "core/film/clean/clean.hpp"
#include "tools/pictures/picture_notes.hpp"

namespace lightnet {
namespace {

const std::string lone_layer = "picture";

Window window_of(const Picture& picture) { return {picture.x, picture.y, picture.width, picture.height}; }

// A name's colour, by its number; bright enough to be told from black.
Rgb colour_of(float id) {
    const auto bits = std::bit_cast<std::uint32_t>(id) * 2654435761u;
    const auto channel = [&](int shift) { return 0.1f + 0.9f * float((bits >> shift) & 0xff) / 255; };
    return {channel(24), channel(16), channel(8)};
}

std::vector<Rgb> as_colours(const PictureMatte& matte) {
    std::vector<Rgb> colours(matte.ranks ? matte.pixels.size() / matte.ranks : 0);
    for (std::size_t i = 0; i < matte.pixels.size(); ++i)
        if (const auto& [id, part] = matte.pixels[i]; part > 0) colours[i / matte.ranks] += colour_of(id) * part;
    return colours;
}

std::vector<Rgb> as_grey(const std::vector<float>& values) {
    std::vector<Rgb> colours;
    for (const float value : values) colours.push_back({value, value, value});
    return colours;
}

bool has_layers(const Picture& picture) { return !picture.layers.empty(); }

bool same_layers(const Picture& one, const Picture& other) {
    return std::ranges::equal(one.layers, other.layers, {}, &PictureLayer::name, &PictureLayer::name);
}

const std::vector<Rgb>* named(const Picture& picture, const std::string& name) {
    for (const auto* layers : {&picture.layers, &picture.shown})
        for (const auto& layer : *layers)
            if (layer.name == name) return &layer.pixels;
    return nullptr;
}

void expect_same_window(const PictureFile& one, const PictureFile& other) {
    const auto size = [](const Picture& picture) {
        return fmt::format("{} x {} pixels from {},{} on", picture.width, picture.height, picture.x, picture.y);
    };
    if (window_of(one.picture) == window_of(other.picture)) return;
    throw UserError({other.name, 0}, "has " + size(other.picture) + ", where " + one.name + " has " +
                                         size(one.picture) + ": only pictures of the same pixels can be compared");
}

}  // namespace

FilmFormat format_of(const Picture& picture) {
    FilmFormat format;
    format.width = picture.whole_width ? picture.whole_width : picture.x + picture.width;
    format.height = picture.whole_height ? picture.whole_height : picture.y + picture.height;
    format.crop = window_of(picture);
    format.samples = noted_samples(picture).value_or(0);
    for (const auto& layer : picture.layers) {
        format.layers.push_back(layer.name);
        format.gains.push_back(layer.gain);
    }
    if (format.layers.empty()) format.layers.push_back(lone_layer);
    for (const auto& layer : picture.shown) {
        format.shown.push_back(layer.name);
        if (layer.letters != usual_letters) format.facts.insert(layer.name);
    }
    for (const auto& matte : picture.mattes) {
        format.shown.push_back(matte.name);
        format.facts.insert(matte.name);
    }
    format.alpha = !picture.alpha.empty();
    return format;
}

ViewedPicture::ViewedPicture(PictureFile shown, std::optional<PictureFile> other)
    : shown_(std::move(shown)), other_(std::move(other)), format_(format_of(shown_.picture)) {
    if (other_) expect_same_window(shown_, *other_);
    for (const auto& matte : shown_.picture.mattes) mattes_.push_back(as_colours(matte));
    if (format_.alpha) mattes_.push_back(as_grey(shown_.picture.alpha));
    const auto window = window_of(shown_.picture);
    const std::size_t colours = sources().size();
    if (const std::size_t bytes = window.pixels() * colours * sizeof(Rgb); bytes > most_bytes)
        throw UserError({shown_.name, 0},
                        fmt::format("is too large to be shown: {} colours of {} x {} pixels take {:.1f} GiB, and {} "
                                    "GiB are the most (lightnet remix writes a PNG of it)",
                                    colours, window.width, window.height, double(bytes) / (1 << 30), most_bytes >> 30));
    board_ = std::make_shared<WatchBoard>(window, colours);
}

// Of each colour of a pixel, in their order: views of the film, layers without noise, and those of the other picture.
std::vector<ViewedPicture::Source> ViewedPicture::sources() const {
    const Picture& own = shown_.picture;
    std::vector<Source> all;
    for (const auto& layer : own.layers) all.push_back(&layer.pixels);
    if (!has_layers(own)) all.push_back(&own.beauty);
    for (const auto& layer : own.shown) all.push_back(&layer.pixels);
    for (const auto& matte : mattes_) all.push_back(&matte);
    const std::size_t views = all.size();
    if (format_.halves())
        for (const auto& layer : (cleaned_ ? *cleaned_ : own).layers) all.push_back(&layer.pixels);
    if (!other_) return all;
    all.push_back(&other_->picture.beauty);
    for (std::size_t k = 0; k < views; ++k) {
        const auto& name = format_.name_of(format_.views()[k]);
        all.push_back(name == lone_layer && !has_layers(own) ? &other_->picture.beauty : named(other_->picture, name));
    }
    return all;
}

Viewed ViewedPicture::viewed() const {
    Viewed viewed;
    const Picture& own = shown_.picture;
    viewed.facts.emplace_back("size", fmt::format("{} x {}", own.width, own.height));
    if (own.whole_width)
        viewed.facts.emplace_back(
            "cut out of", fmt::format("{} x {}, from {}, {} on", own.whole_width, own.whole_height, own.x, own.y));
    if (own.done < 1) viewed.facts.emplace_back("a preview", fmt::format("{:.1f} % of it", 100 * own.done));
    for (const auto& [name, text] : own.notes.texts) viewed.facts.emplace_back(name, text);
    if (!other_) return viewed;
    const auto all = sources();
    const std::size_t views = format_.views().size(), beauty = all.size() - views - 1;
    Viewed::Other other{other_->name, beauty, {}, {}};
    for (std::size_t k = 0; k < views; ++k)
        other.colours.push_back(all[beauty + 1 + k] ? std::optional(beauty + 1 + k) : std::nullopt);
    if (has_layers(own) && same_layers(own, other_->picture))
        for (const auto& layer : other_->picture.layers) other.gains.push_back(layer.gain);
    viewed.other = std::move(other);
    return viewed;
}

std::string ViewedPicture::hello(const Graph& graph, const Registry& registry) const {
    const Viewed more = viewed();
    return hello_json({graph, registry, format_, shown_.name}, &more);
}

void ViewedPicture::show() {
    constexpr std::uint32_t rows = 32;  // at a time: the board is never taken for long
    const auto all = sources();
    const auto window = window_of(shown_.picture);
    for (std::uint32_t y = 0; y < window.height; y += rows) {
        const Tile strip{window.x, window.y + y, window.width, std::min(rows, window.height - y)};
        std::vector<Rgb> pixels;
        pixels.reserve(strip.pixels() * all.size());
        const std::size_t first = std::size_t{y} * window.width;
        for (std::size_t i = 0; i < strip.pixels(); ++i)
            for (const Source source : all) pixels.push_back(source ? (*source)[first + i] : Rgb{});
        while (!board_->show(strip, pixels)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void ViewedPicture::clean() {
    if (!format_.halves()) return;
    cleaned_ = lightnet::clean(shown_.picture).picture;
    show();
}

}  // namespace lightnet
