// The page of a race: curves as SVG, tables, and pictures within the file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/base/base64.hpp"
#include "tools/race/race_text.hpp"

namespace lightnet {
namespace {

constexpr double wide = 720, high = 360, left = 64, bottom = 40, top = 12, right = 12;
constexpr std::array colours{"#2f7fb8", "#d9962b", "#2e7d4f", "#b3392f", "#7a55a8", "#5f6b2d"};

constexpr std::string_view style = R"css(
:root { color-scheme: light dark; --ground: #f6f6f4; --card: #fff; --ink: #1c1d20; --faint: #6a6d75; --line: #dcdcd8; }
@media (prefers-color-scheme: dark) {
  :root { --ground: #141518; --card: #1d1f23; --ink: #e6e6e3; --faint: #9a9da6; --line: #33363d; } }
body { margin: 0; padding: 16px; background: var(--ground); color: var(--ink); font: 14px/1.4 system-ui, sans-serif; }
h1 { font-size: 18px; margin: 0 0 12px; } h2 { font-size: 13px; color: var(--faint); margin: 0 0 8px; }
section { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 12px; margin: 0 0 12px; }
table { border-collapse: collapse; } th { font-weight: 500; color: var(--faint); font-size: 12px; }
th, td { text-align: right; padding: 2px 10px; font-variant-numeric: tabular-nums; } td { border-top: 1px solid var(--line); }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
svg { max-width: 100%; height: auto; } svg text { fill: var(--faint); font-size: 11px; } .grid { stroke: var(--line); }
.pictures { display: flex; flex-wrap: wrap; gap: 12px; } figure { margin: 0; } figcaption { color: var(--faint); }
img { max-width: 320px; image-rendering: pixelated; border-radius: 4px; display: block; }
i { display: inline-block; width: 10px; height: 10px; border-radius: 2px; margin-right: 6px; }
)css";

std::string escaped(std::string_view text) {
    std::string safe;
    for (const char c : text) switch (c) {
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '&':
                safe += "&amp;";
                break;
            case '"':
                safe += "&quot;";
                break;
            default:
                safe += c;
        }
    return safe;
}

std::string figure(const std::string& png, const std::string& caption) {
    if (png.empty()) return {};
    return "<figure><img alt=\"\" src=\"data:image/png;base64," + base64(png) + "\"><figcaption>" + escaped(caption) +
           "</figcaption></figure>\n";
}

// All runs of each, in the order in which they first came.
std::vector<std::pair<std::string, std::vector<const Lap*>>> by_name(const std::vector<Lap>& laps) {
    std::vector<std::pair<std::string, std::vector<const Lap*>>> groups;
    for (const auto& lap : laps) {
        auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& one) { return one.first == lap.name; });
        if (found == groups.end()) found = groups.insert(found, {lap.name, {}});
        found->second.push_back(&lap);
    }
    return groups;
}

// The error of what there was at that time; none: nothing yet.
std::optional<double> error_at(const Lap& lap, double seconds) {
    std::optional<double> error;
    for (const auto& point : lap.curve)
        if (point.seconds <= seconds) error = point.relative_square;
    return error;
}

/// Seconds and errors that a chart shows, both by their logarithms.
struct Axes {
    double first = std::numeric_limits<double>::max(), last = 0, least = first, most = 0;

    explicit Axes(const std::vector<Lap>& laps) {
        for (const auto& lap : laps)
            for (const auto& point : lap.curve) {
                if (!(point.relative_square > 0) || !(point.seconds > 0)) continue;
                first = std::min(first, point.seconds), last = std::max(last, point.seconds);
                least = std::min(least, point.relative_square), most = std::max(most, point.relative_square);
            }
        if (last <= first) first = last > 0 ? last / 2 : 0.5, last = 2 * first;
        if (most <= least) least = most > 0 ? most / 2 : 0.5, most = 2 * least;
    }
    double x(double seconds) const {
        return left + (wide - left - right) * std::log(seconds / first) / std::log(last / first);
    }
    double y(double error) const {
        return top + (high - top - bottom) * std::log(most / std::max(error, least)) / std::log(most / least);
    }
};

// 1, 2 and 5 of each power of ten between two numbers.
std::vector<double> round_numbers(double from, double to) {
    std::vector<double> numbers;
    for (double power = std::pow(10, std::floor(std::log10(from))); power <= to; power *= 10)
        for (const double digit : {1, 2, 5})
            if (const double number = digit * power; number >= from * 0.999 && number <= to * 1.001)
                numbers.push_back(number);
    return numbers;
}

std::string grid_of(const Axes& axes) {
    std::string svg;
    for (const double seconds : round_numbers(axes.first, axes.last))
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text x=\"{0:.1f}\" y=\"{3}\" "
            "text-anchor=\"middle\">{4:g} s</text>\n",
            axes.x(seconds), top, high - bottom, high - bottom + 16, seconds);
    for (const double error : round_numbers(axes.least, axes.most))
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text x=\"{3}\" y=\"{4:.1f}\" "
            "text-anchor=\"end\">{5:g}</text>\n",
            left, wide - right, axes.y(error), left - 6, axes.y(error) + 4, error);
    return svg;
}

// The median over seeds as a line, and all between the least and the most as a band.
std::string curve_of(const std::vector<const Lap*>& laps, const Axes& axes, const char* colour) {
    constexpr int steps = 96;
    std::string line, upper, lower;
    for (int i = 0; i <= steps; ++i) {
        const double seconds = axes.first * std::pow(axes.last / axes.first, double(i) / steps) * 1.000001;
        std::vector<double> errors;
        for (const Lap* lap : laps)
            if (const auto error = error_at(*lap, seconds)) errors.push_back(*error);
        if (errors.size() < laps.size()) continue;
        const auto [least, most] = std::minmax_element(errors.begin(), errors.end());
        const double x = axes.x(seconds);
        line += fmt::format("{:.1f},{:.1f} ", x, axes.y(median(errors)));
        upper += fmt::format("{:.1f},{:.1f} ", x, axes.y(*most));
        lower.insert(0, fmt::format("{:.1f},{:.1f} ", x, axes.y(*least)));
    }
    return fmt::format(
        "<polygon points=\"{0}{1}\" fill=\"{2}\" opacity=\".18\"/><polyline points=\"{3}\" fill=\"none\" "
        "stroke=\"{2}\" "
        "stroke-width=\"2\"/>\n",
        upper, lower, colour, line);
}

template <class Number>
double median_of(const std::vector<const Lap*>& laps, const Number& number) {
    std::vector<double> values;
    for (const Lap* lap : laps) values.push_back(number(*lap));
    return median(std::move(values));
}

std::string row_of(const std::string& name, const std::vector<const Lap*>& laps, const char* colour, double first) {
    const auto error = [](double LapError::*member) {
        return [member](const Lap& lap) { return lap.error ? (*lap.error).*member : 0; };
    };
    const double relmse = median_of(laps, error(&LapError::relative_square));
    return fmt::format(
        "<tr><td><i style=\"background:{}\"></i>{}</td><td>{}</td><td>{:.6g}</td><td>{:.2f}</td><td>{:.4g}</td>"
        "<td>{:.3g}</td><td>{:.4f}</td><td>{:.4f}</td><td>{:.4f}</td></tr>\n",
        colour, escaped(name), laps.size(), median_of(laps, [](const Lap& lap) { return lap.samples; }),
        median_of(laps, [](const Lap& lap) { return lap.seconds; }), relmse, relmse > 0 ? first / relmse : 0,
        median_of(laps, error(&LapError::flip)), median_of(laps, error(&LapError::blocks)),
        median_of(laps, error(&LapError::bias)));
}

}  // namespace

std::string race_page(const std::vector<Lap>& laps, const RacePage& page) {
    const auto groups = by_name(laps);
    const Axes axes(laps);
    std::string chart = grid_of(axes), rows, pictures = figure(page.reference_png, "reference: " + page.reference);
    double first = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const auto& [name, runs] = groups[i];
        const char* const colour = colours[i % colours.size()];
        if (i == 0) first = median_of(runs, [](const Lap& lap) { return lap.error ? lap.error->relative_square : 0; });
        chart += curve_of(runs, axes, colour);
        rows += row_of(name, runs, colour, first);
        pictures += figure(runs.front()->png, name) + figure(runs.front()->flip_png, name + ": FLIP");
    }
    return std::string(race_page_beginning) +
           "<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Race</title><style>" + std::string(style) +
           "</style></head><body>\n" +
           fmt::format("<h1>{:g} seconds each, against {}</h1>\n", page.seconds, escaped(page.reference)) +
           fmt::format(
               "<section><h2>relMSE over seconds: the median over seeds, and all of them</h2>\n<svg viewBox=\"0 0 "
               "{} {}\" width=\"{}\">\n{}</svg></section>\n",
               wide, high, wide, chart) +
           "<section><h2>Where they ended: medians over "
           "seeds</h2><table><tr><th>graph</th><th>seeds</th><th>samples</th>"
           "<th>seconds</th><th>relMSE</th><th>times as good as the "
           "first</th><th>FLIP</th><th>blocks</th><th>bias</th></tr>\n" +
           rows + "</table></section>\n<section><h2>The first seed</h2><div class=\"pictures\">\n" + pictures +
           "</div></section>\n</body></html>\n";
}

}  // namespace lightnet
