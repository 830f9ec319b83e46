// Keys of a run, from what its user says.
#pragma once

#include <string>

#include "core/network/graph/hosts.hpp"
#include "tools/request/run_keys.hpp"
#include "transport/keys/key.hpp"

namespace lightnet {

struct RunningOptions;

/// Throws UserError that names all keys that are none and all hosts that are too far away to be without.
RunKeys run_keys(const RunningOptions& running, const Hosts& hosts);

/// The key of this user; a UserError where there is none. `file` "": the usual one.
KeyPair own_key(const std::string& file);

}  // namespace lightnet
