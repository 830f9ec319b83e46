// The output of `lightnet hosts`.
#pragma once

#include <string>
#include <vector>

#include "core/base/build_info.hpp"
#include "transport/launcher/ask_state.hpp"

namespace lightnet {

/// A line per host, in columns: where it is, its state, its places and its machine; and more for each that serves a
/// run, or whose build is not `build`. A host that was asked and that a launcher has told of, too, stands there once.
std::string host_table(std::vector<HostAnswer> hosts, const std::string& build = build_id());

/// It answers, or its launcher is in touch with it.
bool is_there(const HostAnswer& host);

/// It has said which build it is, and `build` would refuse it.
bool is_other_build(const HostAnswer& host, const std::string& build);

}  // namespace lightnet
