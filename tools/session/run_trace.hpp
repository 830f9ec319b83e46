// The trace of a run, as a file that Perfetto and Chrome's tracing page open.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/run/message/place_trace.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

/// All traces begin with this.
inline constexpr std::string_view trace_beginning =
    "{\"displayTimeUnit\":\"ms\",\"otherData\":{\"format\":\"lightnet trace ";

/// In the Trace Event Format: a process per host, a thread per place, slices, what waits, and an arrow for each bundle
/// of which both ends are there; moves of nodes are marks across all of it. Times are the launcher's, in microseconds
/// from the first event. `nodes`: names by index.
std::string to_trace_json(const std::vector<PlaceTrace>& traces, const std::vector<std::string>& nodes,
                          const std::vector<MoveReport>& moves = {});

}  // namespace lightnet
