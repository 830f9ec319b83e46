// Hosts that are given without nodes: which of them holds what, by what nodes cost.
#pragma once

#include <string>
#include <vector>

#include "core/run/forecast/placement.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/forecast/recorded_run.hpp"

namespace lightnet {

struct Launcher;

/// A mistake in the options of the layout, if any: for when_taken_apart().
std::optional<std::string> mistaken_layout(const RunningOptions& running);

/// Lays the graph out as --layout says: its costs are those of a report, or of a rehearsal, which this renders, few
/// samples of a small picture on this machine. Asks the hosts how they are. Says why, and writes --layout-out. Throws
/// UserError where hosts have nodes already, or don't answer.
Loaded laid_out(const RunningOptions& running, const Launcher& launcher, Loaded loaded);

/// The run of a report, if it is one of this graph. Throws UserError where it is of another.
RecordedRun recorded_run_of(const Graph& graph, const Registry& registry, const std::string& report);

/// Of a graph whose costs a report knows; node by name. Throws UserError where the report is of another graph.
RunCosts costs_for(const Graph& graph, const Registry& registry, const std::string& report);

/// A hosts file, with the reasons as its comments.
std::string hosts_file_text(const Hosts& hosts, const std::vector<std::string>& why);

}  // namespace lightnet
