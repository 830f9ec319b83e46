// Metrics of a daemon, for Prometheus.
#pragma once

#include <chrono>
#include <string>

#include "transport/daemon/host.hpp"

namespace lightnet {

/// In the text format of Prometheus, version 0.0.4; docs/what-a-run-did.md explains the names.
std::string metrics_of(const DaemonFigures& figures);

/// Why it can take no work, now or when its run is over; "": it can.
std::string why_unfit(const DaemonFigures& figures, std::chrono::steady_clock::time_point now);

}  // namespace lightnet
