// Interrupts, as flags.
#pragma once

#include <atomic>

namespace lightnet {

/// Set by signal handlers, read by loops.
struct Signals {
    std::atomic<bool> any{false};          // one of those below came
    std::atomic<bool> interrupted{false};  // SIGINT: stop now
    std::atomic<bool> terminated{false};   // SIGTERM, SIGHUP: finish what is under way, then stop
};

/// From now on SIGINT, SIGTERM and SIGHUP set flags; a second one ends the process at once, with code 130. A terminal
/// that is closed may hang up several times, which counts once; under nohup it counts not at all. Broken pipes are no
/// longer deadly.
const Signals& watch_signals();

/// As a signal does: the run is to finish what is under way, and to stop. Any thread.
void ask_to_stop();

}  // namespace lightnet
