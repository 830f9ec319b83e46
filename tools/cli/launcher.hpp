// Does what the user typed.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <variant>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "tools/cli/settings.hpp"
#include "tools/cli/verb.hpp"
#include "tools/request/run_request.hpp"
#include "tools/request/sequence.hpp"
#include "tools/request/session.hpp"
#include "tools/words/command_line.hpp"
#include "tools/words/program_text.hpp"

namespace lightnet {

/// What the launcher is made of.
struct Launcher {
    const Registry& registry;
    std::function<int(const RunRequest&)> run;  // renders; an exit code
    std::ostream& out;                          // data
    std::ostream& err;                          // messages
    std::vector<Verb> verbs = standard_verbs();
    /// Adds the kinds of these shared libraries to the registry; throws UserError. None: a launcher without plugins.
    std::function<void(const std::vector<std::string>& files)> plug = {};
    Settings settings = {};  // of options that command lines leave open
    /// Renders a sequence; an exit code. None: a launcher of stills.
    std::function<int(Sequence)> run_sequence = {};
    /// Renders, but for so many seconds at most, and keeps the scene for the next of these: trials of a run. An exit
    /// code. None: a launcher without trials.
    std::function<int(const RunRequest&, double seconds)> try_run = {};
    /// Renders what was tried; an exit code. None: as `run`.
    std::function<int(const RunRequest&)> run_tried = {};
    /// Renders a graph while it is edited; an exit code. None: a launcher without sessions.
    std::function<int(const Session&)> run_session = {};

    /// Runs a command line (without the program's name) and returns the exit code; never throws.
    int operator()(const std::vector<std::string>& arguments) const;

private:
    int perform(const std::vector<std::string>& arguments) const;
};

/// Takes a command line (without the program's name) apart. Flags may stand in any order after the verb.
std::variant<Action, Finished> understand(const std::vector<std::string>& arguments, const std::vector<Verb>& verbs);

/// The command line with all its verbs, for manuals.
std::vector<VerbText> launcher_texts(const std::vector<Verb>& verbs);

}  // namespace lightnet
