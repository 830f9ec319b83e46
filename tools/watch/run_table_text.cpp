// The letters of a RunTable.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/watch/run_table.hpp"

namespace lightnet {
namespace {

using Cells = std::vector<std::string>;
constexpr std::size_t most_log_lines = 5;
constexpr std::size_t bar_letters = 20;

std::string short_number(double value) {
    for (const auto& [unit, letter] : {std::pair{1e9, 'G'}, std::pair{1e6, 'M'}, std::pair{1e3, 'k'}})
        if (std::abs(value) >= unit) return fmt::format("{:.3g}{}", value / unit, letter);
    return fmt::format("{:.3g}", value);
}
std::string or_dash(double value, const std::string& text) { return value > 0 ? text : "-"; }
std::string percent_of(double part) { return fmt::format("{:.0f} %", 100 * part); }

std::string span_of(double seconds) {
    const auto whole = std::llround(seconds);
    if (seconds < 10) return fmt::format("{:.1f} s", seconds);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}
std::string brief_time(double seconds) {
    if (seconds >= 1) return fmt::format("{:.1f} s", seconds);
    return seconds >= 1e-3 ? fmt::format("{:.2g} ms", seconds * 1e3) : fmt::format("{:.0f} us", seconds * 1e6);
}

// How many letters a terminal shows of it, and its first so many.
bool goes_on(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }
std::size_t letters(const std::string& text) {
    return text.size() - static_cast<std::size_t>(std::count_if(text.begin(), text.end(), goes_on));
}
std::string first_letters(const std::string& text, std::size_t most) {
    std::size_t end = 0;
    for (std::size_t seen = 0; end < text.size(); ++end)
        if (!goes_on(text[end]) && ++seen > most) break;
    return text.substr(0, end);
}
// What others have named may hold what a terminal would obey.
std::string harmless(std::string text) {
    for (auto& letter : text)
        if (static_cast<unsigned char>(letter) < 32 || letter == 127) letter = '?';
    return text;
}

// The first column to the left, the others to the right; the last one, where it has words, to the left as well.
std::vector<std::string> aligned(const std::vector<Cells>& rows, bool words_at_end) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths.resize(std::max(widths.size(), i + 1));
            widths[i] = std::max(widths[i], letters(row[i]));
        }
    std::vector<std::string> lines;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string room(widths[i] - letters(row[i]), ' ');
            const bool left = i == 0 || (words_at_end && i + 1 == row.size());
            line += (i ? "  " : "") + (left ? row[i] + room : room + row[i]);
        }
        lines.push_back(line.substr(0, line.find_last_not_of(' ') + 1));
    }
    return lines;
}

std::vector<std::string> node_lines(const RunTable& table) {
    const std::string per = table.rates ? "/s" : "";
    std::vector<Cells> rows{
        {"node", "questions" + per, "of time", "wait", "a bundle", "bytes" + per, "answer takes", "kind"}};
    for (const auto& node : table.nodes)
        rows.push_back({harmless(node.name), short_number(node.questions), percent_of(node.share),
                        or_dash(node.waiting, short_number(node.waiting)),
                        or_dash(node.bundle, short_number(node.bundle)), or_dash(node.bytes, short_number(node.bytes)),
                        or_dash(node.latency, brief_time(node.latency)), harmless(node.kind)});
    return aligned(rows, true);
}

std::vector<std::string> host_lines(const RunTable& table) {
    std::vector<Cells> rows{{"host", "places", "busy", "asking", "waiting", "idle", "answered", "state"}};
    for (const auto& host : table.hosts) {
        Cells row{harmless(host.name), std::to_string(host.places)};
        const bool known = std::any_of(host.parts.begin(), host.parts.end(), [](double part) { return part > 0; });
        for (const double part : host.parts) row.push_back(known ? percent_of(part) : "-");
        row.push_back(or_dash(double(host.answered), short_number(double(host.answered))));
        row.push_back(harmless(host.state) + (host.there ? "" : " (gone)"));
        rows.push_back(std::move(row));
    }
    return aligned(rows, true);
}

std::string bar_of(double done) {
    const auto full = static_cast<std::size_t>(std::clamp(done, 0.0, 1.0) * bar_letters);
    return fmt::format("[{}{}] {:.1f} %  ", std::string(full, '#'), std::string(bar_letters - full, '.'), 100 * done);
}

std::string head_line(const RunTable& table) {
    return harmless(table.graph) + "  " + table.standing + "  " + (table.done ? bar_of(*table.done) : "") +
           span_of(table.seconds) + (table.left ? ", " + span_of(*table.left) + " left" : "");
}

// Hosts whose state differs from most others' come first: there may be a thousand.
void cut_hosts(RunTable& table, std::size_t most) {
    if (table.hosts.size() <= most) return;
    std::stable_partition(table.hosts.begin(), table.hosts.end(), [](const auto& host) { return !host.there; });
    table.hosts.resize(most);
}

}  // namespace

std::string to_text(const RunTable& whole, std::size_t columns, std::size_t rows) {
    RunTable table = whole;
    std::vector<std::string> log(table.lines.end() - std::ptrdiff_t(std::min(table.lines.size(), most_log_lines)),
                                 table.lines.end());
    const std::size_t around = 1 + 1 + table.nodes.size() + 1 + 1 + 1 + 1 + log.size();  // with blank lines and heads
    if (rows) cut_hosts(table, std::max<std::size_t>(3, rows > around + 2 ? rows - around - 2 : 0));
    std::vector<std::string> lines{head_line(table), ""};
    for (auto& line : node_lines(table)) lines.push_back(std::move(line));
    lines.emplace_back();
    for (auto& line : host_lines(table)) lines.push_back(std::move(line));
    if (table.hosts.size() < whole.hosts.size())
        lines.push_back(fmt::format("... and {} more", whole.hosts.size() - table.hosts.size()));
    if (!log.empty()) lines.emplace_back();
    for (const auto& line : log) lines.push_back(harmless(line));
    if (rows && lines.size() >= rows) lines.resize(std::max<std::size_t>(1, rows - 1));
    std::string text;
    for (const auto& line : lines) text += (columns ? first_letters(line, columns) : line) + "\n";
    return text;
}

}  // namespace lightnet
