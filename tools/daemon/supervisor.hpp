// A daemon for several runs at a time: one daemon for each, and what looks after them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/daemon/daemon_log.hpp"
#include "tools/support/signals.hpp"

namespace lightnet {

/// What the daemons are that stand for one.
struct SupervisedDaemons {
    std::uint32_t runs = 2;          // so many at a time
    std::string listen;              // where the first of them does
    std::string metrics;             // where the first of them tells Prometheus how it does; "": none does
    std::vector<std::string> words;  // of the command line, for each
    bool quiet = false;              // no log
    std::uint64_t memory = 0;        // bytes that they may hold together, see MemoryBound; 0: any
};

/// What the SIGUSR1 says by which a daemon is told to end: others need its memory. Else it says nothing.
inline constexpr int memory_is_needed = 1;

/// Their ports: the one that the first listens at and those after it, or, where that is left to the system, any that
/// are free. Throws UserError where there are not so many.
std::vector<std::uint16_t> supervised_ports(const SupervisedDaemons& daemons);

/// Starts a daemon at each port, as processes of their own, so that what one run does costs no other; says where the
/// first of them listens; and starts anew what dies. The processors are shared by the system. Returns when a signal
/// told it to stop and all have ended. Throws Error when one doesn't start.
// DECISIONS: a-process-for-each-run
void supervise(const SupervisedDaemons& daemons, const Signals& signals, const DaemonLog& log);

}  // namespace lightnet
