// Keeps the books of a run: the film, the progress, and the report.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/log_entry.hpp"
#include "core/base/spare_threads.hpp"
#include "core/film/film.hpp"
#include "core/film/tone.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/prepare_progress.hpp"
#include "core/run/forecast/mover.hpp"
#include "core/run/message/counters.hpp"
#include "tools/pictures/error_curve.hpp"
#include "tools/pictures/picture_notes.hpp"
#include "tools/request/run_request.hpp"
#include "tools/session/checkpoint_keeper.hpp"
#include "tools/session/film_steps.hpp"
#include "tools/support/pace.hpp"
#include "tools/support/progress.hpp"
#include "tools/support/run_report.hpp"
#include "tools/watch/watcher.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet {

/// One thread's. Tiles come in, files go out.
class RunRecorder {
public:
    /// `tile`: pixels along a side.
    RunRecorder(FilmFormat format, ProgressMode progress, std::uint32_t tile, RunReport report,
                std::optional<Progress::Series> series = {});
    RunRecorder(const RunRecorder&) = delete;
    RunRecorder& operator=(const RunRecorder&) = delete;

    /// Another part of the run begins; the one before has ended.
    void phase(const std::string& name);
    void say(const LogEntry& entry);
    /// From now on, those who watch are shown what happens. Outlives the book, or until the run is told to end.
    void show_to(Watcher* watcher) { watcher_ = watcher; }
    /// Those who watch may ask how its pixels come about.
    void share(const std::shared_ptr<const Network>& network, const MadeFrom& made_from) {
        if (watcher_) watcher_->share(network, made_from, scale_);
    }
    /// Somebody may watch.
    bool shown() const { return watcher_ != nullptr; }
    /// Shows what is new, to be called several times a second.
    void show(const Watcher::Hosts& hosts);
    void show_last(const Watcher::Hosts& hosts) {
        if (watcher_) watcher_->part_from(hosts);
    }
    void show_handed_out(const std::vector<Tile>& tiles) { watcher_->handed_out(tiles); }
    /// The last thing that those who watch are shown.
    void show_outcome(const std::string& outcome, ForecastCurve forecast);
    /// Writes a page that shows what the run did. Throws Error.
    void write_report_page(const std::string& html);
    /// What they want.
    std::vector<WatchCommand> wishes() { return watcher_->commands(); }
    /// How far preparing is.
    void preparing(const PrepareProgress& progress);
    /// What is worth knowing, and costs nothing that was asked for.
    void warn(const std::string& text);
    /// What was asked for is lost, or in doubt, or in danger, though the run goes on: an error, and said as one however
    /// little else is.
    void alert(const std::string& text);
    /// What the files of the picture say of it beside its pixels.
    void describe(PictureWords words) { words_ = std::move(words); }
    /// Where the picture goes as arrays of NumPy; "": nowhere.
    void keep_arrays(const std::string& npz) { arrays_ = npz; }
    /// How the PNG shows the picture; `exposed`: that has an exposure which somebody has chosen.
    void show_png(const PngRequest& png, bool exposed) { png_ = png, exposed_ = exposed; }
    /// By this, logs of hosts call the run, too.
    void name_run(std::uint64_t number);
    /// What the scene's film makes of radiance. Before the first tile.
    void expose(float scale);
    /// From now on, writes what is there every so many seconds.
    void preview(const std::string& exr, double seconds);
    /// With the report, writes there what all places were busy with.
    void trace_to(const std::string& file) { trace_ = file; }
    /// From now on, writes the picture after each step, the first of which is coarse, and says so.
    void show_steps(const std::string& exr, std::function<void(const PictureShown&)> shown);
    /// Says that the picture is written, which took `writing` seconds of the phase; none: nobody wants to know.
    void tell_shown(bool finished, double writing = 0);
    /// Writes what is there now. "": it is written; else why not.
    std::string preview_now(const std::string& exr);
    /// The phase ends, and all that follows is of another thread, while another run goes on beside this one.
    void stand_aside();
    /// While something takes long (a large file, a picture to be cleaned), calls `attend` all the time: hosts that hear
    /// nothing for seconds take the run for gone. Null: there are none. It must not throw.
    void attend_by(std::function<void()> attend) { attend_ = std::move(attend); }
    /// Pixels of a tile. Returns the tiles that are wanted now, beside those that are wanted anyhow.
    std::vector<Tile> take(const Tile& tile, std::span<const Rgb> pixels);
    /// Who holds what, from now on.
    void use(const Plan& plan, const Graph& graph);
    /// The run is to end so many seconds after it began; 0: when it is done.
    void limit_time(double seconds);
    bool time_is_over() const { return steps_.limit().over(Pace::Clock::now()); }
    /// None: it takes as long as it takes.
    std::optional<std::chrono::milliseconds> time_left() const;
    /// Says at the end how far the picture is from a reference.
    void compare_with(ErrorCurve curve);
    /// The tiles to be rendered next, when those before are there. None: there is no more to do, or no time.
    std::vector<Tile> next_step();
    /// Nothing more is rendered: what is there is the picture. In words: "37 samples per pixel of 64, on average"; "":
    /// nothing is there.
    std::string end_early();
    /// Every pixel has samples of its own.
    bool covered() const { return steps_.picture().covered() == 1 && !steps_.picture().format().coarse; }
    /// A line of the report's settings.
    void set(const std::string& name, const std::string& value) { report_.settings[name] = value; }
    void count(const Counters& counters) { counters_ += counters; }
    /// Warns of the nodes that made what is not finite: those that answered so, while none that they ask did; of those
    /// that asked about no surface; and of the layers that lack light.
    void name_bad_light(const Graph& graph);
    /// Who took part. Once more when it has ended the run: then it has said how much memory that took.
    void use(const HostState& host);
    /// Nodes go to other hosts now.
    void moved(const Move& move);

    /// From now on the film is saved beside `exr` from time to time, in the background. `recipe` is what the picture
    /// depends on; `memo`: where it is kept when it is finished, null: nowhere.
    void keep_checkpoint(const std::string& exr, std::map<std::string, std::string> recipe, std::chrono::seconds period,
                         std::unique_ptr<FilmMemo> memo = nullptr);
    /// Takes up what an earlier run left there, if anything and if that is wanted; else what the memo has. Throws
    /// UserError when what was left there was another picture's.
    void take_up_checkpoint(bool resume);
    /// Of all samples, 0 to 1.
    double share_done() const {
        return all_blocks_ ? static_cast<double>(blocks_) / static_cast<double>(all_blocks_) : 0;
    }
    /// Nothing is wanted any more.
    bool complete() const { return steps_.finished(); }
    /// All that is there is in doubt: the film is empty again, and so is the checkpoint beside it.
    void begin_anew();
    /// There is something worth to be kept.
    bool keeps_checkpoint() const { return checkpoint_ && blocks_ > 0; }
    /// Saves what is there now; false: nothing was worth it. Where that would take longer than `most`, what was saved
    /// last stays, which is said.
    bool save_checkpoint(std::optional<std::chrono::duration<double>> most = {});
    /// Of a picture that is finished: the checkpoint stays, so that a later run may add samples, or is removed. A disk
    /// that refuses it only costs a warning.
    void end_checkpoint(bool stays);

    /// Writes x.exr, and x.png beside it, each whole or not at all. Throws Error, also when files of others are there.
    void write_picture(const std::string& exr);
    /// Is the file there, and what write_picture() would write?
    bool is_written(const std::string& exr) const;
    /// The last words of a run that is done. `asked`: hosts that were to take part; `exposure`: stops.
    void conclude(const Hosts& asked, double exposure);
    /// Writes the report beside `exr`: x.run.json; or x.run.failed.json, where that is the picture of an earlier run.
    void write_report(const std::string& exr, const std::string& outcome);

private:
    struct Preview {
        std::string exr;
        Pace pace;
        bool said = false;
    };
    /// What was written last.
    struct Written {
        double stops = 0;  // by which the PNG is brighter than its picture
        Brightness brightness;
        double step = 0;  // samples, of the last step
        bool is_preview = false;
    };
    template <class Work>
    auto apart(const Work& work);
    Picture picture_now() const;
    void write_files(const std::string& exr, bool quickly = false);
    void write_clean(const std::string& exr);
    std::string write_preview();
    void write_step();
    void write_trace();
    std::filesystem::path report_file(const std::string& exr, const std::string& outcome) const;
    void end_phase(Pace::Clock::time_point now);
    void end_doing(Pace::Clock::time_point now);

    const Film& film() const { return steps_.film(); }
    void note_error(Pace::Clock::time_point now);
    std::uint64_t work_shown() const;

    FilmSteps steps_;
    float scale_ = 1;
    PictureWords words_;
    PngRequest png_ = PictureView::plain;
    bool exposed_ = false;
    std::string arrays_;  // file; "": none
    std::optional<ErrorCurve> curve_;
    Pace::Clock::time_point begun_ = Pace::Clock::now();
    Written last_;
    std::set<std::string> written_;                       // pictures
    std::string last_prepared_;                           // node that was named
    std::optional<Pace::Clock::time_point> doing_since_;  // what stands last in the report's `preparing`
    bool said_overflow_ = false;
    std::function<void()> attend_;
    Watcher* watcher_ = nullptr;
    std::optional<Preview> preview_;
    std::string step_exr_;
    std::function<void(const PictureShown&)> shown_;  // none: steps are not written
    std::optional<CheckpointKeeper> checkpoint_;
    std::string trace_;                     // file; "": none
    std::vector<std::string> graph_nodes_;  // names by index
    RunReport report_;
    std::uint64_t all_blocks_;
    Progress progress_;
    Counters counters_;
    std::uint64_t blocks_ = 0, repeated_ = 0;  // of tiles
    std::optional<Pace::Clock::time_point> phase_begun_;
};

template <class Work>
auto RunRecorder::apart(const Work& work) {
    constexpr std::chrono::milliseconds often(20);
    if (!attend_) return work();
    auto done = in_background(work);
    while (done.wait_for(often) != std::future_status::ready) attend_();
    return done.get();
}

}  // namespace lightnet
