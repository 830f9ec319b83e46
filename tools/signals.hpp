// Interrupts, as flags.
#pragma once

#include <atomic>

namespace lightnet {

/// Set by signal handlers, read by loops.
struct Signals {
    std::atomic<bool> any{false};          // SIGINT or SIGTERM came
    std::atomic<bool> interrupted{false};  // SIGINT: stop now
    std::atomic<bool> terminated{false};   // SIGTERM: finish what is under way, then stop
};

/// From now on SIGINT and SIGTERM set flags; a second one ends the process at once, with code 130. Broken pipes are no
/// longer deadly.
const Signals& watch_signals();

}  // namespace lightnet
