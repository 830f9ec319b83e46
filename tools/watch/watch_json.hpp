// JSON for the page. A page and its launcher are of one build, so the words are nobody else's.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/json_tree.hpp"
#include "core/film/film.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/run/assembly/activity.hpp"
#include "tools/forecast/forecast_curve.hpp"
#include "tools/support/run_report.hpp"
#include "tools/watch/viewpoint.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet {

/// What does not change while a run goes.
struct WatchedRun {
    const Graph& graph;
    const Registry& registry;
    const FilmFormat& format;
    std::string output;
    bool edited = false;  // by those who watch, too
    /// Of a sequence, by its number, and what became of each: "" is still to come. None: a still.
    struct Frames {
        int at_work = 0;
        std::vector<std::pair<int, std::string>> all;
    };
    std::optional<Frames> frames{};
};

/// What does.
struct WatchedState {
    double seconds = 0;  // since it began
    std::string phase;
    double done = 0;                  // 0 … 1
    std::optional<double> left{};     // seconds; none: not known
    std::vector<MoveReport> moves{};  // of nodes, so far
    std::vector<HostState> hosts;
    Doings doing;
    std::vector<Tile> in_flight;
    std::optional<Viewpoint> viewpoint{};  // none: not known yet
    std::optional<JsonTree> parts{};       // parts_to_edit(); none: nobody edits
    std::string outcome;                   // "": it goes on
    ForecastCurve forecast{};              // of a run that is over
};

/// A finished picture that is looked at, where nothing runs. A value.
struct Viewed {
    /// Another one, to be compared with. Its colours stand behind those of the picture.
    struct Other {
        std::string file;
        std::size_t beauty = 0;                           // number of that colour
        std::vector<std::optional<std::size_t>> colours;  // for each of the picture's own: that of the same name
        std::vector<Rgb> gains;                           // of its layers; empty: they are others than the picture's
    };
    std::vector<std::pair<std::string, std::string>> facts;  // what its file says: what, and how much
    std::optional<Other> other;
};

/// {"hello": {…}}
std::string hello_json(const WatchedRun& run, const Viewed* viewed = nullptr);
/// {"t": …, …}. With more than a hundred places, a row is a host; with more than a hundred hosts, a hundred are named,
/// without their machines, those that are lost first, and one entry ("rest") is the sum of the others.
std::string state_json(const WatchedState& state, const Graph& graph);

}  // namespace lightnet
