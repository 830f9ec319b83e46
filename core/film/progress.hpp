// Tells the user how far a run is, and how long it will take.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

namespace lightnet {

/// How progress is shown. automatic: a bar on a terminal, plain lines elsewhere.
enum class ProgressMode { automatic, bar, plain, json, none };

/// "auto", "bar", "plain", "json" or "none".
std::optional<ProgressMode> progress_mode(std::string_view text);

/// One bar for the whole run on a terminal; elsewhere a plain line every ten seconds or ten percent; or a JSON object
/// per line. Time is an argument, so nothing here waits or looks at a clock. One thread.
class Progress {
public:
    using Time = std::chrono::steady_clock::time_point;

    struct Style {
        ProgressMode mode = ProgressMode::automatic;
        bool terminal = false;  // what `automatic` looks at
        bool colour = false;    // bar only
    };

    /// The style for standard error: looks at the terminal and at NO_COLOR.
    static Style style_of_stderr(ProgressMode wanted);

    /// `total` is the work of the run in any unit (tiles); the time left is estimated from work done since `now`.
    Progress(std::uint64_t total, Style style, std::ostream& out, Time now);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Another part of the run begins ("prepare", "render"). One line; the one before is said to have ended.
    void phase(std::string_view name, Time now);
    /// Work that was there before the run began (resumed): counts as done, but says nothing about speed.
    void found_done(std::uint64_t work, Time now);
    /// `done` is the whole work done so far.
    void update(std::uint64_t done, Time now);
    /// Says something without tearing the bar apart. Said even where no progress is shown.
    void say(std::string_view message);
    /// The last line. A bar stays where it is if the work was not finished.
    void finish(Time now);

    /// Seconds until all is done, at the speed so far; none before the first work is done.
    std::optional<double> seconds_left(Time now) const;

private:
    void report(Time now);
    void draw_bar(Time now);
    void clear_bar();
    void line_of_json(std::string_view event, Time now);
    double fraction() const;

    std::uint64_t total_, done_ = 0, found_ = 0;
    ProgressMode mode_;
    bool colour_;
    std::ostream& out_;
    Time begun_, phase_begun_, work_begun_, reported_;
    std::string phase_;
    int tenths_ = 0;  // plain: the last tenth of the work that was said
    bool bar_shown_ = false;
};

}  // namespace lightnet
