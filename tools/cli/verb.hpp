// A verb of the launcher: `lightnet NAME ...`. To add one, see tools/CMakeLists.txt.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace lightnet {

struct Launcher;

/// A command line that is understood: what is left to do. Returns an exit code; throws UserError or Error.
using Action = std::function<int(const Launcher&)>;

struct Verb {
    std::string name;  // "render"
    std::string help;  // one line
    /// Describes the verb's options to `app`, which fills them when it takes a command line apart. What is returned
    /// does the verb's work with them.
    std::function<Action(CLI::App& app)> options;
};

/// A verb whose options are a struct of its own: `describe(app, options)` tells `app` of them, and `run(options,
/// launcher)` is called with what was typed.
template <class Options, class Describe, class Run>
Verb verb(std::string name, std::string help, Describe describe, Run run) {
    return {std::move(name), std::move(help), [describe, run](CLI::App& app) -> Action {
                const auto options = std::make_shared<Options>();
                describe(app, *options);
                return [options, run](const Launcher& launcher) { return run(*options, launcher); };
            }};
}

/// All verbs, in the order in which the help lists them.
std::vector<Verb> standard_verbs();

}  // namespace lightnet
