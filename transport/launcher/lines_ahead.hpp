// Lines that are open before they are needed: for runs that follow each other on the same hosts.
#pragma once

#include <memory>

#include "transport/lines/host_transport.hpp"

namespace lightnet {

/// As `hosts`, but while a line is in use another to the same host is opened beside it, and whoever connects there next
/// has that: making a connection, with its handshake, takes longer than what is said on it before a run begins. A line
/// that has waited for a minute is closed, and another opened. One thread's, like its lines.
std::shared_ptr<HostTransport> lines_ahead(std::shared_ptr<HostTransport> hosts);

}  // namespace lightnet
