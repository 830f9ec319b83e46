// A report of a run, as what it says of costs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/network/graph/dot_moves.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/forecast/run_costs.hpp"

namespace lightnet {

/// A value.
struct RecordedRun {
    Graph graph;  // without sectors, checked
    RunCosts costs;
    Plan plan;                        // who did it
    std::vector<ForecastHost> hosts;  // of the plan, at speed 1
    double seconds = 0;               // from loading to writing
    std::vector<DrawnMove> moves;     // of nodes, in mid-run
};

/// What a report says of a move: "caustic goes from a to b, c". Throws Error where it says something else.
DrawnMove move_said(const std::string& text);

/// Reads x.run.json. Throws UserError where it tells too little: of a run of one thread, whose pieces nobody timed, of
/// one that an older version has recorded, or of one that was not done.
RecordedRun read_recorded_run(const std::filesystem::path& report, const Registry& registry);

/// Another picture of the same scene; 0: as it was.
struct OtherPicture {
    std::uint32_t width = 0, height = 0, samples = 0, tile = 0, frames = 0;
};
/// What that costs: a piece of the picture as much as one of the same size did, a sample as much as a sample.
RunCosts scaled(RunCosts costs, const OtherPicture& other);

}  // namespace lightnet
