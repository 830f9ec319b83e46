#include "core/film/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

namespace lightnet {
namespace {

using namespace std::chrono_literals;

constexpr auto bar_interval = 100ms, json_interval = 250ms, plain_interval = 10000ms;
constexpr int bar_width = 30;

double seconds(Progress::Time::duration time) { return std::chrono::duration<double>(time).count(); }

// "42 s", "3:07", "2:15:00".
std::string clock_text(double seconds) {
    const auto whole = std::llround(seconds);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string left_text(std::optional<double> left) { return left ? clock_text(*left) + " left" : "estimating"; }

}  // namespace

std::optional<ProgressMode> progress_mode(std::string_view text) {
    using enum ProgressMode;
    constexpr std::array<std::pair<std::string_view, ProgressMode>, 5> modes{
        {{"auto", automatic}, {"bar", bar}, {"plain", plain}, {"json", json}, {"none", none}}};
    for (const auto& [name, mode] : modes)
        if (name == text) return mode;
    return {};
}

Progress::Style Progress::style_of_stderr(ProgressMode wanted) {
    const bool terminal = ::isatty(STDERR_FILENO);
    const char* no_color = std::getenv("NO_COLOR");  // https://no-color.org: set and not empty
    return {wanted, terminal, terminal && !(no_color && *no_color)};
}

Progress::Progress(std::uint64_t total, Style style, std::ostream& out, Time now)
    : total_(total),
      mode_(style.mode),
      colour_(style.colour),
      out_(out),
      begun_(now),
      phase_begun_(now),
      work_begun_(now),
      reported_(now) {
    if (mode_ == ProgressMode::automatic) mode_ = style.terminal ? ProgressMode::bar : ProgressMode::plain;
}

double Progress::fraction() const {
    return total_ ? static_cast<double>(std::min(done_, total_)) / static_cast<double>(total_) : 1;
}

std::optional<double> Progress::seconds_left(Time now) const {
    if (done_ >= total_) return 0.0;
    if (done_ <= found_) return {};
    const double rate = seconds(now - work_begun_) / static_cast<double>(done_ - found_);
    return rate * static_cast<double>(total_ - done_);
}

void Progress::phase(std::string_view name, Time now) {
    if (!phase_.empty() && mode_ != ProgressMode::json)
        say(fmt::format("{}: {:.1f} s", phase_, seconds(now - phase_begun_)));
    phase_ = name;
    phase_begun_ = work_begun_ = now;
    if (mode_ == ProgressMode::json) line_of_json("phase", now);
    if (mode_ == ProgressMode::bar && !phase_.empty()) draw_bar(now);
}

void Progress::found_done(std::uint64_t work, Time now) {
    found_ = done_ = work;
    tenths_ = static_cast<int>(fraction() * 10);
    work_begun_ = now;
}

void Progress::update(std::uint64_t done, Time now) {
    done_ = done;
    report(now);
}

void Progress::report(Time now) {
    const auto since = now - reported_;
    const int tenths = static_cast<int>(fraction() * 10);
    if (mode_ == ProgressMode::bar && (since >= bar_interval || !bar_shown_)) {
        draw_bar(now);
    } else if (mode_ == ProgressMode::json && since >= json_interval) {
        line_of_json("progress", now);
    } else if (mode_ == ProgressMode::plain && (since >= plain_interval || tenths > tenths_)) {
        out_ << fmt::format("{} {:.0f} %, {}\n", phase_.empty() ? "done" : phase_, fraction() * 100,
                            left_text(seconds_left(now)))
             << std::flush;
        tenths_ = tenths;
    } else {
        return;
    }
    reported_ = now;
}

void Progress::draw_bar(Time now) {
    const int full = static_cast<int>(fraction() * bar_width);
    const std::string_view on = colour_ ? "\x1b[32m" : "", off = colour_ ? "\x1b[0m" : "";
    out_ << fmt::format("\r\x1b[K{:<8} [{}{}{}{}] {:3.0f} %  {}", phase_, on,
                        std::string(static_cast<std::size_t>(full), '='), off,
                        std::string(static_cast<std::size_t>(bar_width - full), ' '), fraction() * 100,
                        left_text(seconds_left(now)))
         << std::flush;
    bar_shown_ = true;
}

void Progress::clear_bar() {
    if (std::exchange(bar_shown_, false)) out_ << "\r\x1b[K";
}

void Progress::line_of_json(std::string_view event, Time now) {
    nlohmann::ordered_json line{
        {"event", event}, {"phase", phase_}, {"done", done_}, {"total", total_}, {"seconds", seconds(now - begun_)}};
    if (const auto left = seconds_left(now)) line["seconds_left"] = *left;
    out_ << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
}

void Progress::say(std::string_view message) {
    clear_bar();
    if (mode_ == ProgressMode::json) {
        const nlohmann::ordered_json line{{"event", "message"}, {"text", message}};
        out_ << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
    } else {
        out_ << message << std::endl;
    }
}

void Progress::finish(Time now) {
    if (mode_ == ProgressMode::json) return line_of_json("finish", now);
    if (mode_ == ProgressMode::bar) {
        draw_bar(now);
        out_ << "\n";
        bar_shown_ = false;
    }
    phase({}, now);
}

}  // namespace lightnet
