#include "tools/forecast/forecast_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/json_tree.hpp"
#include "core/base/printable.hpp"

namespace lightnet {
namespace {

// By the name of BusyPart::What.
constexpr std::array part_names{"places",          "host",      "node", "line", "launcher_line",
                                "launcher_thread", "preparing", "alone"};

struct Interval {
    double least, most;
};
Interval interval_of(const Forecast& forecast, double doubt) {
    return {forecast.least * (1 - doubt), forecast.most * (1 + doubt)};
}

JsonTree tree_of(const ForecastTable& table, const ForecastRow& row) {
    const auto& what = row.what;
    JsonTree parts = JsonTree::list(), nodes = JsonTree::object();
    for (const auto& part : what.parts)
        parts.push_back({{"what", part_names.at(std::size_t(part.what))}, {"name", part.name}, {"share", part.share}});
    for (std::size_t node = 0; node < table.nodes.size(); ++node)
        if (what.by_node[node] > 0) nodes[table.nodes[node]] = what.by_node[node];
    const auto [least, most] = interval_of(what, doubt_in(table));
    JsonTree tree = {
        {"hosts", row.hosts},  {"places", row.places}, {"seconds", what.seconds},      {"least", least},
        {"most", most},        {"load", what.load},    {"prepare", what.prepare},      {"render", what.render},
        {"write", what.write}, {"work", what.work},    {"efficiency", what.efficiency}};
    tree["nodes"] = std::move(nodes);
    tree["busy"] = std::move(parts);
    tree["advice"] = advice_for(what);
    return tree;
}

std::string line_of(const ForecastTable& table, const ForecastRow& row) {
    const auto [least, most] = interval_of(row.what, doubt_in(table));
    const auto& busiest = row.what.parts.front();
    return fmt::format("{:6} {:7}  {:>12}  {:>12} {:>12}  {:8.1f} %  {} ({:.0f} %)\n", row.hosts, row.places,
                       duration_text(row.what.seconds), duration_text(least), duration_text(most),
                       100 * row.what.efficiency, words_for(busiest), 100 * busiest.share);
}

}  // namespace

double doubt_in(const ForecastTable& table) {
    constexpr double least = 0.02;
    if (table.recorded <= 0) return least;
    return std::clamp(std::abs(table.replayed / table.recorded - 1), least, 0.9);
}

std::string duration_text(double seconds) {
    if (seconds < 100) return fmt::format("{:.3g} s", seconds);
    const auto whole = std::llround(seconds);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string to_text(const ForecastTable& table) {
    std::string text =
        fmt::format("{}x{}, {} samples, {} {}; the recorded run took {}, and {} are foreseen of it\n", table.width,
                    table.height, table.samples, table.frames, table.frames == 1 ? "frame" : "frames",
                    duration_text(table.recorded), duration_text(table.replayed));
    text += " hosts  places          takes          from           to  efficiency  busiest\n";
    for (const auto& row : table.rows) text += line_of(table, row);
    if (!table.rows.empty()) text += advice_for(table.rows.back().what) + "\n";
    return text;
}

std::string to_json(const ForecastTable& table) {
    JsonTree rows = JsonTree::list();
    for (const auto& row : table.rows) rows.push_back(tree_of(table, row));
    JsonTree json;
    json["format"] = "lightnet forecast 1";
    json["report"] = table.report;
    json["recorded"] = table.recorded;
    json["replayed"] = table.replayed;
    json["picture"] = {
        {"width", table.width}, {"height", table.height}, {"samples", table.samples}, {"frames", table.frames}};
    json["rows"] = std::move(rows);
    json.change_texts(in_utf8);
    return to_text(json, {.indent = 2}) + "\n";
}

}  // namespace lightnet
