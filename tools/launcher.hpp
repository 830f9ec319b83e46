// Does what the user typed.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <variant>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "tools/command_line.hpp"
#include "tools/run.hpp"
#include "tools/verbs/verb.hpp"

namespace lightnet {

/// What the launcher is made of.
struct Launcher {
    const Registry& registry;
    std::function<int(const RunRequest&)> run;  // renders; an exit code
    std::ostream& out;                          // data
    std::ostream& err;                          // messages
    std::vector<Verb> verbs = standard_verbs();

    /// Runs a command line (without the program's name) and returns the exit code; never throws.
    int operator()(const std::vector<std::string>& arguments) const;
};

/// Takes a command line (without the program's name) apart. Flags may stand in any order after the verb.
std::variant<Action, Finished> understand(const std::vector<std::string>& arguments, const std::vector<Verb>& verbs);

}  // namespace lightnet
