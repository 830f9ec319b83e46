// Runs one after the other of the same scene, of which each may be given up when it has taken long enough.
#pragma once

#include <memory>

#include "core/network/graph/kind.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// Keeps the scene as it was read and built from run to run, and what nodes have prepared, in memory. One thread's.
class TrialRuns {
public:
    explicit TrialRuns(const Registry& registry);
    ~TrialRuns();
    TrialRuns(const TrialRuns&) = delete;
    TrialRuns& operator=(const TrialRuns&) = delete;

    /// Renders, with so many seconds of processor time at most, however busy the machine is. An exit code: that of an
    /// interrupted run where they were over, or where the user has told it to end. Throws UserError or Error.
    int run(const RunRequest& request, double seconds);
    /// The run for which these were: the whole of it.
    int run_to_end(const RunRequest& request);

private:
    struct Shared;
    std::unique_ptr<Shared> shared_;
};

}  // namespace lightnet
