// Trials of several ways to light a scene: small pictures with few samples.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "tools/request/run_request.hpp"
#include "tools/trials/lighting_choice.hpp"

namespace lightnet {

/// One way, and the run that tries it. A value.
struct TrialRequest {
    std::string name;
    RunRequest request;      // its seed and file are not those that are used
    std::string excluded{};  // why it can't be chosen, and isn't tried but for judging others; "": it can
    bool is_biased = false;  // noise tells only a part of its error
    bool records = false;    // of what it prepares, only records along what is seen grow with the picture
    /// What of the figures is known before: how preparing grows.
    LightingTrial known{};
};

/// How trials are run.
struct TrialCourse {
    /// Renders, and gives it up after so many seconds of processor time; an exit code.
    std::function<int(const RunRequest&, double seconds)> run;
    std::function<double()> processor_seconds;  // that this process has used
    AskedPicture asked;
    double triangles = 0;  // of the scene
    // Of what the best so far takes, for all trials together: so much for each time that less error x time is promised,
    // but no less and no more than that.
    double part_of_promise = 0.02, least_part = 0.06, most_part = 0.3;
    double least_seconds = 0.05;  // with less left, no other trial begins
};

/// The user has told a trial to end.
struct TrialInterrupted {};

/// Figures of all, in their order. The first one has as long as it takes, and must not fail: throws Error or UserError
/// where it does. What it says of light paths decides which others are tried at all: see promise_of(). They are judged
/// by it, for which it is rendered twice. Throws TrialInterrupted where the user ends one.
std::vector<LightingTrial> run_trials(const std::vector<TrialRequest>& requests, const TrialCourse& course);

}  // namespace lightnet
