// The account that a run gives of itself: in words while it goes on, to those who watch, and in its report.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/log_entry.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/prepare_progress.hpp"
#include "core/run/forecast/mover.hpp"
#include "core/run/message/counters.hpp"
#include "tools/session/phase_times.hpp"
#include "tools/support/progress.hpp"
#include "tools/support/run_report.hpp"
#include "tools/watch/watcher.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet {

/// One thread's.
class RunAccount {
public:
    using Clock = std::chrono::steady_clock;

    /// `work`: of the run, in blocks of tiles. It begins now.
    RunAccount(RunReport report, ProgressMode mode, std::optional<Progress::Series> series, std::uint64_t work);

    /// Where others write what they know.
    RunReport& report() { return report_; }
    Progress& progress() { return progress_; }
    /// From now on, those who watch are shown what happens. Outlives the account, or until the run is told to end.
    void show_to(Watcher* watcher) { watcher_ = watcher; }
    /// None: nobody can watch.
    Watcher* watcher() const { return watcher_; }

    /// Another part of the run begins; the one before has ended.
    void phase(const std::string& name);
    const PhaseTimes& phases() const { return phases_; }
    /// The phase ends, and all that follows is of another thread, while another run goes on beside this one.
    void stand_aside();
    /// How far preparing is.
    void preparing(const PrepareProgress& progress);
    void say(const LogEntry& entry);
    /// What is worth knowing, and costs nothing that was asked for.
    void warn(const std::string& text);
    /// What was asked for is lost, or in doubt, or in danger, though the run goes on: an error, and said as one however
    /// little else is. Once.
    void alert(const std::string& text);
    /// A line of the report's settings.
    void set(const std::string& name, const std::string& value) { report_.settings[name] = value; }
    void count(const Counters& counters) { counters_ += counters; }
    const Counters& counted() const { return counters_; }
    /// Who holds what, from now on.
    void use(const Plan& plan, const Graph& graph);
    /// Who took part. Once more when it has ended the run: then it has said how much memory that took.
    void use(const HostState& host);
    /// Nodes go to other hosts now.
    void moved(const Move& move);
    /// Nothing follows: figures and counters go into the report, and what places were busy with into `trace`; "": into
    /// none.
    void end(const std::string& outcome, const std::string& trace);

private:
    RunReport report_;
    PhaseTimes phases_{report_};
    Progress progress_;
    Counters counters_;
    Watcher* watcher_ = nullptr;
    std::vector<std::string> graph_nodes_;  // names by index
};

/// Alerts of the nodes that made what is not finite: those that answered so, while none that they ask did; and of those
/// that asked about no surface, or what can't be answered.
void alert_of_bad_light(RunAccount& account, const Graph& graph);

}  // namespace lightnet
