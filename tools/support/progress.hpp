// Tells the user how far a run is, and how long it will take.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightnet {

/// How progress is shown. automatic: a bar on a terminal, plain lines elsewhere.
enum class ProgressMode { automatic, bar, plain, json, none };

/// "auto", "bar", "plain", "json" or "none".
std::optional<ProgressMode> progress_mode(std::string_view text);

/// What clears the line of the bar, if there may be one, so that another can be written there.
std::string_view room_for_line(ProgressMode mode, bool terminal);

/// One bar for the whole run on a terminal, never longer than a line of it; elsewhere, from the third second on, a
/// plain line every ten seconds or ten percent; or a JSON object per line. Time is an argument, so nothing here waits
/// or looks at a clock. One thread.
class Progress {
public:
    using Time = std::chrono::steady_clock::time_point;

    /// Of a sequence of runs, whose bar all of them move.
    struct Series {
        int frame = 1;
        std::size_t index = 0, count = 1;  // of this one, among all that are to be rendered
        Time begun{};                      // the first
    };

    struct Style {
        ProgressMode mode = ProgressMode::automatic;
        bool terminal = false;  // what `automatic` looks at
        bool colour = false;    // bar only
        /// Letters in a line of the terminal, now: people change it while they wait.
        std::function<int()> columns = [] { return 80; };
        std::optional<Series> series{};
    };

    /// The style for standard error: looks at the terminal and at NO_COLOR.
    static Style style_of_stderr(ProgressMode wanted);

    /// `total` is the work of the run in any unit (tiles); the time left is estimated from work done since `now`.
    Progress(std::uint64_t total, Style style, std::ostream& out, Time now);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Another part of the run begins ("prepare", "render"). One line says how long the one before took, if that was a
    /// second or more.
    void phase(std::string_view name, Time now);
    /// The run ends by then, whatever is left.
    void end_by(Time end) { end_ = end; }
    /// Work that was there before the run began (resumed): counts as done, but says nothing about speed.
    void found_done(std::uint64_t work, Time now);
    /// `done` is the whole work done so far.
    void update(std::uint64_t done, Time now);
    /// The phase is at a step of which so much is done: for phases before the work. `name` says what it does. Of 0: not
    /// known.
    void step(std::string_view name, std::uint64_t done, std::uint64_t total, Time now);
    /// Members that a line of JSON has besides, and their values.
    using Marks = std::vector<std::pair<std::string, std::string>>;
    /// Says something without tearing the bar apart. Mode none: says nothing.
    void say(std::string_view message, const Marks& marks = {});
    /// Says it in every mode: for what is an error, though the run goes on.
    void insist(std::string_view message, const Marks& marks = {});
    /// From now on the bar is that of another run, which goes on beside this one; lines are whole among those of both.
    void stand_aside();
    /// The last line. A bar goes when the work is finished, and stays where it is when not.
    void finish(Time now);

    /// Seconds until all is done (or the step, if there is one), at the speed so far, or the run ends; none: not known.
    std::optional<double> seconds_left(Time now) const;

private:
    /// A part of a phase.
    struct Step {
        std::string name;
        std::uint64_t done = 0, total = 0;
        Time begun;
    };
    void report(Time now);
    bool due(Time now);
    void plain_line(Time now);
    void draw_bar(Time now);
    std::string bar_text(std::size_t columns, Time now) const;
    std::string label() const;
    std::optional<double> seconds_of_work_left(Time now) const;
    std::optional<double> seconds_of_series_left(Time now) const;
    std::string_view without_bar();
    void line_of_json(std::string_view event, Time now);
    double own_fraction() const;
    double fraction() const;

    std::uint64_t total_, done_ = 0, found_ = 0;
    ProgressMode mode_;
    Style style_;
    std::ostream& out_;
    Time begun_, phase_begun_, work_begun_, reported_;
    std::optional<Time> end_;  // by then
    std::string phase_;
    std::optional<Step> step_;
    int tenths_ = 0;  // plain: the last tenth of the work that was said
    enum class Bar { none, shown, of_another } bar_ = Bar::none;
};

}  // namespace lightnet
