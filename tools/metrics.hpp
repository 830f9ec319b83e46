// What a daemon does, for Prometheus.
#pragma once

#include <string>

#include "transport/daemon/host.hpp"

namespace lightnet {

/// In the text format of Prometheus, version 0.0.4; docs/what-a-run-did.md explains the names.
std::string metrics_of(const DaemonFigures& figures);

}  // namespace lightnet
