// What the user of lightnetd typed.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "tools/command_line.hpp"
#include "transport/daemon/host.hpp"

namespace lightnet {

struct DaemonOptions {
    Host::Options host;
    std::string single;  // no other daemon of this name beside it; "": any
    int parent = 0;      // the process without which it ends; 0: none
    bool quiet = false;  // no log
};

/// Takes a command line (without the program's name) apart.
std::variant<DaemonOptions, Finished> parse_daemon_options(const std::vector<std::string>& arguments);

}  // namespace lightnet
