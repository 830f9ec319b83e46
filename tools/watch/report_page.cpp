#include "tools/watch/report_page.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/base/base64.hpp"
#include "core/base/error.hpp"
#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "tools/watch/live_cleaning.hpp"
#include "tools/watch/watch_page.hpp"

namespace lightnet {
namespace {

// Nine bits for each channel, and one exponent for all three, as in RGB9E5 of graphics cards.
std::uint32_t packed(const Rgb& colour) {
    constexpr int bias = 24;
    const auto sane = [](float channel) {
        return channel > 0 && std::isfinite(channel) ? std::min(channel, 65408.0f) : 0;
    };
    const std::array channels{sane(colour.r), sane(colour.g), sane(colour.b)};
    const float most = std::max({channels[0], channels[1], channels[2], 0x1p-24f});
    int exponent = std::max(0, std::ilogb(most) + 16);
    if (std::lround(std::ldexp(most, bias - exponent)) > 511) ++exponent;
    std::uint32_t word = static_cast<std::uint32_t>(exponent) << 27;
    for (std::size_t c = 0; c < 3; ++c)
        word |= static_cast<std::uint32_t>(std::lround(std::ldexp(channels[c], bias - exponent))) << (9 * c);
    return word;
}

std::string_view bytes_of(const std::vector<std::uint32_t>& words) {
    static_assert(std::endian::native == std::endian::little);
    return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof words[0]};
}

/// The pixels that are shown of a picture, in both directions every step-th one.
struct Sieve {
    Window window;
    std::size_t colours;
    std::uint32_t step = 1;
    std::uint32_t width() const { return (window.width + step - 1) / step; }
    std::uint32_t height() const { return (window.height + step - 1) / step; }
    std::size_t words() const { return std::size_t{width()} * height() * colours; }
};

void take_area(const Tile& area, const std::vector<Rgb>& pixels, const Sieve& sieve,
               std::vector<std::uint32_t>& words) {
    for (std::uint32_t row = 0; row < area.height; ++row)
        for (std::uint32_t column = 0; column < area.width; ++column) {
            const std::uint32_t x = area.x + column - sieve.window.x, y = area.y + row - sieve.window.y;
            if (x % sieve.step || y % sieve.step) continue;
            const std::size_t to = (std::size_t{y / sieve.step} * sieve.width() + x / sieve.step) * sieve.colours;
            for (std::size_t k = 0; k < sieve.colours; ++k)
                words[to + k] = packed(pixels[(std::size_t{row} * area.width + column) * sieve.colours + k]);
        }
}

// With the colours that hello_json() tells of.
JsonTree frozen_picture(const Film& film, std::size_t most_bytes) {
    LiveCleaning cleaning(film.format());
    cleaning.finish(film);
    Sieve sieve{film.format().work(), film.format().views().size() + cleaning.colours()};
    const auto bytes = [&] { return sieve.words() * 16 / 3; };
    while (bytes() > most_bytes && sieve.step < std::max(sieve.window.width, sieve.window.height)) ++sieve.step;
    if (bytes() > most_bytes) throw Error("report", "it has no room for a picture of so many layers");
    std::vector<std::uint32_t> words(sieve.words());
    for (const Tile& area : film.areas()) take_area(area, cleaning.so_far(film, area), sieve, words);
    return {{"width", sieve.width()},
            {"height", sieve.height()},
            {"step", sieve.step},
            {"pixels", base64(bytes_of(words))}};
}

JsonTree noted(const std::string& text) try {
    return JsonTree(parse_json(text));
} catch (const JsonError&) {  // whose words are for programmers
    throw Error("report", "what was noted while the run went is damaged");
}

// As part of a page, where "</script>" would end it.
std::string within_script(std::string json) {
    std::string text;
    text.reserve(json.size());
    for (const char letter : json)
        if (letter == '<')
            text += "\\u003c";
        else
            text += letter;
    return text;
}

void replace_once(std::string& text, std::string_view what, const std::string& by) {
    const auto at = text.find(what);
    if (at == text.npos) throw Error("report", "the page has no place for what it is to show");
    text.replace(at, what.size(), by);
}

}  // namespace

std::string report_page(const Watcher& watcher, const Film& film, const ReportFacts& facts) {
    auto history = JsonTree::list();
    for (const auto& state : watcher.history()) history.push_back(noted(state));
    auto json = noted(watcher.noted().hello);
    json["state"] = noted(watcher.noted().last_state);
    json["history"] = std::move(history);
    json["log"] = watcher.noted().lines;
    json["facts"] = JsonTree::list();
    for (const auto& [name, value] : facts) json["facts"].push_back({name, value});
    const auto text = [&] { return within_script(sorted_text(json)); };
    const std::size_t taken = watch_page().size() + text().size() + 1000;
    json["picture"] = frozen_picture(film, most_report_bytes - std::min(taken, most_report_bytes));

    std::string page(watch_page());
    replace_once(page, "<!--frozen-->", "<script type=\"application/json\" id=\"frozen\">" + text() + "</script>");
    // It fetches nothing, whatever is in it.
    replace_once(page, "<meta charset=\"utf-8\">",
                 "<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
                 "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:\">");
    return page;
}

}  // namespace lightnet
