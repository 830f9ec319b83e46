// Whom a verb asks, as the command line and hosts files say.
#pragma once

#include <string>
#include <vector>

#include "transport/launcher/ask_state.hpp"

namespace CLI {
class App;
}

namespace lightnet {

/// What the command line says of them.
struct AskedHostsOptions {
    std::vector<std::string> whom;  // endpoints and hosts files
    std::string key;                // file with our own; "": the usual one
    std::string host_key;           // of the endpoints that stand on the command line
};

/// The options of the keys.
void add_asking_keys(CLI::App& app, AskedHostsOptions& options);

/// Whom they name, in order, each with the keys by which it is asked.
struct AskedHosts {
    std::vector<AskedHost> called;
    std::vector<std::string> joining;  // names of those that join by themselves, and can't be called
};

/// Reads the hosts files. Throws UserError. Before threads are started.
AskedHosts asked_hosts(const AskedHostsOptions& options);

}  // namespace lightnet
