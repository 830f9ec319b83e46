// Interrupts, as flags.
#pragma once

#include <atomic>
#include <chrono>
#include <string_view>

namespace lightnet {

/// Set by signal handlers, read by loops.
struct Signals {
    std::atomic<bool> any{false};                         // one of those below came: the picture is not wanted
    std::atomic<bool> interrupted{false};                 // SIGINT: stop now
    std::atomic<bool> terminated{false};                  // the others: finish what is under way, then stop
    std::atomic<int> said{0};                             // with a SIGUSR1, see sigqueue(3)
    std::atomic<bool> superseded{false};                  // no signal: another picture is wanted instead
    std::atomic<std::chrono::steady_clock::rep> came{0};  // the first signal: when
};

/// From now on SIGINT, SIGTERM, SIGHUP and SIGUSR1 (by which Slurm warns of its time limit) set flags; a second one
/// ends the process at once, with code 130. A terminal that is closed may hang up several times, which counts once;
/// warnings do not count. What is ignored when the program starts stays so: SIGHUP under nohup, SIGINT in the
/// background jobs of a script. Broken pipes are no longer deadly.
const Signals& watch_signals();

/// Until then, or for good: they end the process with `code` and `words` on standard error, which stay where they are.
/// To be called first of all; what is ignored stays so, as above, and SIGUSR1 does nothing.
void end_on_signals(int code, std::string_view words);

/// Whoever ends programs gives them some ten seconds to end in order, and then none: how much is left of it.
std::chrono::duration<double> time_to_end(const Signals& signals);

/// As a signal does: the run is to finish what is under way, and to stop. Any thread.
void ask_to_stop();

}  // namespace lightnet
