#include "tools/support/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/base/json_tree.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;

constexpr auto bar_interval = 100ms, json_interval = 250ms, plain_interval = 10000ms;
constexpr auto plain_silence = 3s;  // a phase that takes no longer needs no lines
constexpr auto worth_a_line = 1s;   // a phase
constexpr std::string_view clear_line = "\r\x1b[K";
constexpr std::size_t longest_bar = 30, shortest_bar = 5, longest_label = 48;

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

std::string_view room_for_line(ProgressMode mode, bool terminal) {
    const bool bar = mode == ProgressMode::bar || (mode == ProgressMode::automatic && terminal);
    return bar ? clear_line : "";
}

Progress::Style Progress::style_of_stderr(ProgressMode wanted) {
    const bool terminal = ::isatty(STDERR_FILENO);
    const char* no_color = std::getenv("NO_COLOR");  // https://no-color.org: set and not empty
    const auto columns = [] {
        winsize size{};
        return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
    };
    return {wanted, terminal, terminal && !(no_color && *no_color), columns};
}

Progress::Progress(std::uint64_t total, Style style, std::ostream& out, Time now)
    : total_(total),
      mode_(style.mode),
      style_(std::move(style)),
      out_(out),
      begun_(now),
      phase_begun_(now),
      work_begun_(now),
      reported_(now) {
    if (mode_ == ProgressMode::automatic) mode_ = style_.terminal ? ProgressMode::bar : ProgressMode::plain;
    if (style_.series) tenths_ = static_cast<int>(fraction() * 10);
    if (mode_ != ProgressMode::json) return;
    JsonTree line{{"event", "begin"}, {"format", "lightnet progress 1"}, {"total", total_}};
    if (const auto& series = style_.series) line["frame"] = series->frame;
    out_ << to_text(line) + '\n' << std::flush;
}

double Progress::fraction() const {
    const auto& series = style_.series;
    if (!series) return own_fraction();
    const double own = step_ ? 0 : own_fraction();
    return (static_cast<double>(series->index) + own) / static_cast<double>(series->count);
}

std::optional<double> Progress::seconds_of_series_left(Time now) const {
    const double done = fraction();
    if (!(done > 0)) return {};
    return seconds(now - style_.series->begun) * (1 - done) / done;
}

double Progress::own_fraction() const {
    const auto [done, total] = step_ ? std::pair(step_->done, step_->total) : std::pair(done_, total_);
    if (!total) return step_ ? 0 : 1;
    return static_cast<double>(std::min(done, total)) / static_cast<double>(total);
}

std::optional<double> Progress::seconds_left(Time now) const {
    const auto work = seconds_of_work_left(now);
    if (!end_) return work;
    const double limit = std::max(0.0, seconds(*end_ - now));
    return work ? std::min(*work, limit) : limit;
}

std::optional<double> Progress::seconds_of_work_left(Time now) const {
    const auto left = [](double so_far, std::uint64_t done, std::uint64_t to_do) {
        return so_far / static_cast<double>(done) * static_cast<double>(to_do);
    };
    if (style_.series) return seconds_of_series_left(now);
    if (step_) {
        if (step_->done == 0) return {};
        return left(seconds(now - step_->begun), step_->done, step_->total - step_->done);
    }
    if (done_ >= total_) return 0.0;
    if (done_ <= found_) return {};
    return left(seconds(now - work_begun_), done_ - found_, total_ - done_);
}

void Progress::phase(std::string_view name, Time now) {
    if (!phase_.empty() && mode_ != ProgressMode::json && now - phase_begun_ >= worth_a_line)
        say(fmt::format("{}: {:.1f} s", phase_, seconds(now - phase_begun_)));
    phase_ = name;
    step_.reset();
    phase_begun_ = work_begun_ = now;
    if (mode_ == ProgressMode::json) line_of_json("phase", now);
    if (mode_ == ProgressMode::bar && !phase_.empty()) draw_bar(now);
}

void Progress::step(std::string_view name, std::uint64_t done, std::uint64_t total, Time now) {
    const bool same = step_ && step_->name == name && step_->total == total && step_->done <= done;
    if (!same) step_ = Step{std::string(name), 0, total, now};
    step_->done = std::min(done, total);
    report(now);
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

bool Progress::due(Time now) {
    const auto since = now - reported_;
    switch (mode_) {
        case ProgressMode::bar:
            return since >= bar_interval || bar_ == Bar::none;
        case ProgressMode::json:
            return since >= json_interval;
        case ProgressMode::plain:
            if (now - phase_begun_ < plain_silence) return false;
            return since >= plain_interval || (!step_ && static_cast<int>(fraction() * 10) > tenths_);
        default:
            return false;
    }
}

void Progress::report(Time now) {
    if (!due(now)) return;
    if (mode_ == ProgressMode::bar) draw_bar(now);
    if (mode_ == ProgressMode::json) line_of_json(step_ ? "step" : "progress", now);
    if (mode_ == ProgressMode::plain) plain_line(now);
    reported_ = now;
}

void Progress::plain_line(Time now) {
    out_ << fmt::format("{} {:.0f} %, {}\n", step_ ? phase_ + " " + label() : label(), fraction() * 100,
                        left_text(seconds_left(now)))
         << std::flush;
    if (!step_) tenths_ = static_cast<int>(fraction() * 10);
}

std::string Progress::label() const {
    const auto of_frame = style_.series ? fmt::format("frame {} ", style_.series->frame) : "";
    if (step_) return of_frame + step_->name;
    return of_frame + (phase_.empty() ? "done" : phase_);
}

// "render   [=====     ]  50 %  3 s left", never longer than a line: the bar shortens first, then goes.
std::string Progress::bar_text(std::size_t columns, Time now) const {
    const auto name = fmt::format("{:<8} ", label().substr(0, longest_label));
    const auto rest = fmt::format("{:3.0f} %  {}", fraction() * 100, left_text(seconds_left(now)));
    const std::size_t used = name.size() + 3 + rest.size();  // with the ends of the bar, and the space behind it
    if (used + shortest_bar >= columns) return (name + rest).substr(0, columns - 1);
    const std::size_t length = std::min(longest_bar, columns - 1 - used);
    const auto full = static_cast<std::size_t>(fraction() * static_cast<double>(length));
    const std::string_view on = style_.colour ? "\x1b[32m" : "", off = style_.colour ? "\x1b[0m" : "";
    return fmt::format("{}[{}{}{}{}] {}", name, on, std::string(full, '='), off, std::string(length - full, ' '), rest);
}

// The last column stays free: some terminals go to the next line when it is filled.
void Progress::draw_bar(Time now) {
    if (bar_ == Bar::of_another) return;
    out_ << std::string(clear_line) + bar_text(static_cast<std::size_t>(std::max(style_.columns(), 2)), now)
         << std::flush;
    bar_ = Bar::shown;
}

// What makes room for other lines.
std::string_view Progress::without_bar() {
    if (bar_ == Bar::of_another) return room_for_line(mode_, style_.terminal);
    return std::exchange(bar_, Bar::none) == Bar::shown ? clear_line : "";
}

void Progress::stand_aside() {
    out_ << without_bar() << std::flush;
    bar_ = Bar::of_another;
}

void Progress::line_of_json(std::string_view event, Time now) {
    JsonTree line{
        {"event", event}, {"phase", phase_}, {"done", done_}, {"total", total_}, {"seconds", seconds(now - begun_)}};
    if (step_) line["step"] = step_->name, line["step_done"] = step_->done, line["step_total"] = step_->total;
    if (const auto left = seconds_left(now)) line["seconds_left"] = *left;
    if (const auto& series = style_.series)
        line["frame"] = series->frame, line["frames_done"] = series->index, line["frames"] = series->count;
    out_ << to_text(line) + '\n' << std::flush;
}

void Progress::say(std::string_view message, const Marks& marks) {
    if (mode_ != ProgressMode::none) insist(message, marks);
}

void Progress::insist(std::string_view message, const Marks& marks) {
    std::string text(message);
    if (mode_ == ProgressMode::json) {
        JsonTree line{{"event", "message"}, {"text", message}};
        for (const auto& [name, value] : marks) line[name] = value;
        text = to_text(line);
    }
    out_ << fmt::format("{}{}\n", without_bar(), text) << std::flush;
}

void Progress::finish(Time now) {
    if (mode_ == ProgressMode::json) return line_of_json("finish", now);
    if (mode_ == ProgressMode::bar && done_ < total_ && bar_ != Bar::of_another) {
        draw_bar(now);
        out_ << "\n";
        bar_ = Bar::none;
    }
    if (bar_ == Bar::shown) out_ << without_bar();
    phase({}, now);
}

}  // namespace lightnet
