// What `lightnet hosts` prints.
#pragma once

#include <string>
#include <vector>

#include "transport/launcher/ask_state.hpp"

namespace lightnet {

/// A line per host, in columns: where it is, its state, its places and its machine; and more for each that serves a
/// run. A host that was asked and that a launcher has told of, too, stands there once.
std::string host_table(std::vector<HostAnswer> hosts);

/// It answers, or its launcher is in touch with it.
bool is_there(const HostAnswer& host);

}  // namespace lightnet
