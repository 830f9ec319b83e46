// Options of lightnetd.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "tools/words/command_line.hpp"
#include "tools/words/program_text.hpp"
#include "transport/daemon/host.hpp"

namespace lightnet {

struct DaemonOptions {
    Host::Options host;
    std::string single;                // no other daemon of this name beside it; "": any
    int parent = 0;                    // the process without which it ends; 0: none
    bool led = false;                  // tells its key, and ends it, by the standard input
    bool quiet = false;                // no log
    bool log_json = false;             // lines of JSON
    std::string key_file;              // of its own key; "": the usual one
    bool print_key = false;            // and nothing else
    std::vector<std::string> plugins;  // shared libraries
    std::uint32_t runs = 1;            // that it serves at a time, see supervise()
    std::uint64_t memory = 0;          // bytes that they may hold together; 0: any
    int supervisor = 0;                // the process that started it as one of several, without which it ends; 0: none
    std::string metrics;               // address at which it tells Prometheus how it does; "": nowhere
};

/// Takes a command line (without the program's name) apart.
std::variant<DaemonOptions, Finished> parse_daemon_options(const std::vector<std::string>& arguments);

/// The command line, for manuals.
std::vector<VerbText> daemon_texts();

}  // namespace lightnet
