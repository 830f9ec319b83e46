// By which keys a run and its hosts know each other.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/network/graph/hosts.hpp"
#include "transport/keys/allow_list.hpp"
#include "transport/keys/key.hpp"
#include "transport/start/ssh_workers.hpp"

namespace lightnet {

/// A value.
struct RunKeys {
    KeyPair own = KeyPair::random();           // of the launcher
    std::map<std::string, PublicKey> hosts{};  // that are called, by endpoint; the others have none
    std::optional<JoinKeys> join{};            // none: hosts join by the pass
    std::optional<KeyPair> slurm{};            // of the daemons that Slurm starts
    std::vector<SshWorkers::Host> ssh{};       // that are started by ssh
};

}  // namespace lightnet
