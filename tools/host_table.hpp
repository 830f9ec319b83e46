// What `lightnet hosts` prints.
#pragma once

#include <string>
#include <vector>

#include "transport/ask_state.hpp"

namespace lightnet {

/// A line per host, in columns, and one more for each that serves a run.
std::string host_table(const std::vector<HostAnswer>& hosts);

}  // namespace lightnet
