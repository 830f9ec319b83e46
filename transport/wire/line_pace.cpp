#include "transport/wire/line_pace.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr double under_way_for = .5;  // seconds: so long the line is busy with what was sent
constexpr double longest_way = .3;    // seconds: a longer one is a line that was busy from the beginning
constexpr std::size_t parts = 4;      // pieces in a window, and marks
constexpr std::size_t after_loss = 256 << 10;
constexpr double shortest_doubt = 1;  // seconds, whether an answer was lost
constexpr double longest_wait = 5;    // seconds

}  // namespace

std::size_t LinePace::piece() const { return std::clamp(window_ / parts, least_piece, most_piece_); }

bool LinePace::wants_mark(bool blocked, Time now) const {
    if (blocked && !marks_.empty())
        return std::chrono::duration<double>(now - marks_.back().when).count() > std::max(shortest_doubt, 4 * took_);
    const auto unmarked = sent_ - (marks_.empty() ? taken_ : marks_.back().sent);
    return unmarked >= window_ / parts || (blocked && unmarked > 0);
}

void LinePace::sent(std::size_t bytes, Time now) {
    if (sent_ == (marks_.empty() ? taken_ : marks_.back().sent)) first_unmarked_ = now;
    sent_ += bytes;
}

void LinePace::mark(Time now) {
    marks_.push_back(
        {sent_, under_way(), marks_.empty() ? first_unmarked_ : marks_.front().first, first_unmarked_, now});
}

void LinePace::taken(std::uint64_t mark, Time now) {
    // of a connection that is no more
    if (marks_.empty() || mark < marks_.front().sent || mark > marks_.back().sent) return;
    while (marks_.front().sent < mark) marks_.pop_front();
    const auto last = marks_.front();
    marks_.pop_front();
    taken_ = last.sent;
    measure(last, now);
}

void LinePace::sent_piece(std::size_t bytes, Time now) {
    sent(bytes, now);
    mark(now);
}

void LinePace::piece_taken(Time now) {
    if (!marks_.empty()) taken(marks_.front().sent, now);
}

// What was under way when the mark went was taken since the first of it was sent. Where little is sent that is less
// than the line could take, and never more.
void LinePace::measure(const Mark& mark, Time now) {
    const auto seconds_since = [&](Time then) {
        return std::max(std::chrono::duration<double>(now - then).count(), 1e-6);
    };
    took_ = seconds_since(mark.when);
    way_ = std::min({way_, took_, longest_way});
    if (mark.when < adjusted_) return;
    const double wanted = under_way_for + way_, window = static_cast<double>(window_);
    const double rate = static_cast<double>(mark.under_way) / seconds_since(mark.since);
    const double next =
        took_ > wanted ? window * std::max(.5, wanted / took_) : std::clamp(rate * wanted, window, 2 * window);
    const auto bounded =
        static_cast<std::size_t>(std::clamp(next, static_cast<double>(least_piece), static_cast<double>(most_)));
    if (bounded == window_) return;
    window_ = bounded;
    adjusted_ = now;
}

std::chrono::milliseconds LinePace::expected() const {
    if (marks_.empty()) return {};
    return std::chrono::milliseconds(static_cast<std::int64_t>(std::min(2 * took_, longest_wait) * 1e3));
}

void LinePace::restart() {
    taken_ = sent_;
    marks_.clear();
    window_ = std::min(window_, after_loss);
}

}  // namespace lightnet
