#include "tools/cli/frames.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>

#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_frames = 10000;  // of one command line
constexpr int highest_frame = 9'999'999;

/// From the first to the last, by steps.
struct Range {
    int first = 0, last = 0, step = 1;
};

/// Takes a number from the beginning of a text. None: there is none.
std::optional<int> take_number(std::string_view& text) {
    int number = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault != std::errc{} || number < 0 || text.front() == '-') return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

bool take(std::string_view& text, char letter) {
    if (text.empty() || text.front() != letter) return false;
    text.remove_prefix(1);
    return true;
}

std::optional<Range> range_of(std::string_view text) {
    Range range;
    const auto first = take_number(text);
    if (!first) return std::nullopt;
    range.first = range.last = *first;
    if (text.empty()) return range;
    const auto last = take(text, '-') ? take_number(text) : std::nullopt;
    if (!last) return std::nullopt;
    range.last = *last;
    if (text.empty()) return range;
    const auto step = take(text, 'x') ? take_number(text) : std::nullopt;
    if (!step || !text.empty()) return std::nullopt;
    range.step = *step;
    return range;
}

std::string with_all(std::string text, std::string_view what, std::string_view by) {
    for (auto at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

/// What somebody may have meant who writes frames as other programs do. "": nobody knows.
std::string meant_by(const std::string& text) {
    std::string guess = with_all(text, " ", "");
    for (const char* dots : {"...", "..", ":"}) guess = with_all(guess, dots, "-");
    guess = with_all(with_all(guess, ";", ","), "--", "-");
    if (const auto first = guess.find('-'); first != guess.npos)  // 1-240-2, which was 1:240:2
        if (const auto second = guess.find('-', first + 1); second != guess.npos && guess.find(',') == guess.npos)
            guess[second] = 'x';
    return guess != text && std::holds_alternative<std::vector<int>>(frames_of(guess)) ? guess : "";
}

std::string mistake_in(const Range& range, std::string_view part) {
    if (range.last < range.first)
        return "frames go upwards: " + std::to_string(range.last) + "-" + std::to_string(range.first) + ", not " +
               std::string(part);
    if (range.step == 0) return "every 0th frame is none: " + std::string(part);
    if (range.last > highest_frame) return "frames have numbers up to " + std::to_string(highest_frame);
    return {};
}

}  // namespace

std::variant<std::vector<int>, std::string> frames_of(std::string_view text) {
    std::vector<int> frames;
    std::set<int> known;
    const std::string_view all = text;
    while (true) {
        const auto part = text.substr(0, text.find(','));
        const auto range = range_of(part);
        if (!range) {
            const auto guess = meant_by(std::string(all));
            return "frames are like 1-240, 1-240x2 or 1,5,9-12, not '" + std::string(all) + "'" +
                   (guess.empty() ? "" : " (did you mean '" + guess + "'?)");
        }
        if (auto mistake = mistake_in(*range, part); !mistake.empty()) return mistake;
        for (int frame = range->first; frame <= range->last && frames.size() <= most_frames; frame += range->step)
            if (known.insert(frame).second) frames.push_back(frame);
        if (part.size() == text.size()) break;
        text.remove_prefix(part.size() + 1);
    }
    if (frames.size() > most_frames)
        return "at most " + std::to_string(most_frames) + " frames at once, which are more: " + std::string(all);
    return frames;
}

namespace {

CLI::Option* add_numbers(CLI::App& verb, std::vector<int>& numbers, const std::string& help) {
    return verb
        .add_option_function<std::string>(
            "--frames", [&numbers](const std::string& text) { numbers = std::get<std::vector<int>>(frames_of(text)); },
            help)
        ->type_name("1-240|1-240x2|1,5,9-12")
        ->check([](const std::string& text) {
            const auto found = frames_of(text);
            const auto* mistake = std::get_if<std::string>(&found);
            return mistake ? *mistake : "";
        });
}

}  // namespace

void add_frames(CLI::App& verb, FrameOptions& frames) {
    auto* const asked = add_numbers(verb, frames.numbers,
                                    "render a sequence: a graph's 'frame' and 'time' are those of each, and -o "
                                    "shot.####.exr names the pictures");
    takes_amounts(verb.add_option("--fps", frames.fps, "frames per second, instead of the graph's (else 24)"), "N",
                  Least::above_zero)
        ->needs(asked);
}

void add_only_frames(CLI::App& verb, std::vector<int>& numbers) { add_numbers(verb, numbers, "only these"); }

}  // namespace lightnet
