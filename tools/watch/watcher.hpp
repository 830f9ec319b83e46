// Collects what those who watch a run are shown.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/run/assembly/prepare_progress.hpp"
#include "tools/explain/live_explainer.hpp"
#include "tools/preview/tev_preview.hpp"
#include "tools/preview/watch_board.hpp"
#include "tools/support/pace.hpp"
#include "tools/watch/live_cleaning.hpp"
#include "tools/watch/places_at_work.hpp"
#include "tools/watch/watch_history.hpp"
#include "tools/watch/watch_json.hpp"
#include "tools/watch/watch_server.hpp"

namespace lightnet {

/// Belongs to the run's thread, and takes next to nothing of it while nobody watches. What the page asks for comes out
/// of commands(); an end is passed on at once.
class Watcher {
public:
    using Clock = std::chrono::steady_clock;
    struct Options {
        std::optional<WatchAddress> address;  // none: nobody can watch; what is collected is for report()
        std::optional<WatchAddress> viewer;   // tev, which is shown the picture; none: isn't
        bool report = false;                  // keeps what a report shows of the past
        std::function<void()> end = {};       // the run is to end; called by another thread
        LiveExplainer* explainer = nullptr;   // of pixels, for those who watch; outlives the watcher
        WatchServer* server = nullptr;        // that shows one run after the other; none: this run has its own
    };
    /// All of `run` outlives it. Throws Error when the address can't be listened at, or the viewer's name is nobody's.
    Watcher(Options options, const WatchedRun& run);
    ~Watcher();
    Watcher(const Watcher&) = delete;
    Watcher& operator=(const Watcher&) = delete;

    /// For the user, with the token; "": nobody can watch.
    std::string url() const;
    /// Somebody watches, has, or will read a report.
    bool wanted() const { return options_.report || board_->wanted(); }
    /// Its last picture is: somebody watches it, or may come to it later.
    bool picture_wanted() const { return options_.server || board_->wanted(); }

    /// From where the picture is seen, and what can be edited of its scene: parts_to_edit().
    void look_from(const Viewpoint& viewpoint, JsonTree parts) {
        state_.viewpoint = viewpoint, state_.parts = std::move(parts);
    }
    void phase(const std::string& name);
    /// Places of this process render with that; a pixel of it can be explained without reading the scene again.
    void share(const std::shared_ptr<const Network>& network, const MadeFrom& made_from, float scale) {
        if (options_.explainer) options_.explainer->share(network, made_from, scale);
    }
    void say(const std::string& text);
    /// What a node does while it prepares.
    void preparing(const PrepareProgress& progress);
    /// How much is there, 0 … 1, how many seconds are left (none: not known), and which nodes have moved so far. Shown
    /// by the next look.
    void progress(double done, std::optional<double> left, const std::vector<MoveReport>& moves) {
        state_.done = done, state_.left = left;
        if (moves.size() != state_.moves.size()) state_.moves = moves;
    }
    void handed_out(const std::vector<Tile>& tiles);
    /// A tile has come, and is in the film.
    void taken(const Tile& tile);
    /// Shows what is new, if it is time.
    void look(const Film& film);
    /// Shows what is new and who takes part, which is asked for when it is time to.
    using Hosts = std::function<std::vector<HostState>()>;
    void look(const Film& film, const Hosts& hosts);
    /// The last time that hosts can be asked.
    void part_from(const Hosts& hosts);
    std::vector<WatchCommand> commands();
    /// What there is to say of the viewer.
    std::vector<std::string> news() { return viewer_ ? viewer_->news() : std::vector<std::string>{}; }
    /// Shows all that is there, as the last thing.
    void finish(const Film& film, const std::string& outcome, ForecastCurve forecast = {});

    /// How many places were at work, on average over the time that they were looked at.
    double at_work() const { return work_.average(); }
    /// What a report is made from, with history().
    struct Noted {
        std::string hello, last_state;
        std::vector<std::string> lines;
    };
    const Noted& noted() const { return noted_; }
    const std::vector<std::string>& history() const { return history_.states(); }

private:
    void take_areas_of(const Film& film);
    void show_pixels(const Film& film, std::chrono::duration<double> most);
    bool tell();
    void look_at_hosts(std::vector<HostState> hosts, Clock::time_point now);

    Options options_;
    const Graph& graph_;
    std::string output_;
    Noted noted_;
    WatchedState state_;
    PlacesAtWork work_;
    const Clock::time_point begun_ = Clock::now();
    std::shared_ptr<WatchBoard> board_;
    bool too_large_ = false;
    LiveCleaning cleaning_;
    std::optional<std::deque<Tile>> changed_;  // areas; none: nobody has come yet
    Pace pixel_pace_, state_pace_;
    WatchHistory history_;
    std::mutex commands_mutex_;
    std::vector<WatchCommand> commands_;
    std::unique_ptr<TevPreview> viewer_;
    std::unique_ptr<WatchServer> own_server_;  // last: its thread, like the viewer's, uses the rest
    WatchServer* server_ = nullptr;            // that, or another; null: nobody can watch
};

}  // namespace lightnet
