// Does what the user typed.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "tools/options.hpp"
#include "tools/run.hpp"

namespace lightnet {

/// What the launcher is made of.
struct Launcher {
    const Registry& registry;
    std::function<int(const RunRequest&)> run;  // renders; an exit code
    std::ostream& out;                          // data
    std::ostream& err;                          // messages

    /// Runs a command line (without the program's name) and returns the exit code; never throws.
    int operator()(const std::vector<std::string>& arguments) const;

private:
    int perform(const Options& options) const;
    int perform_run(const Options& options) const;
    int perform_render(Options options) const;
    int perform_check(const Options& options) const;
    int perform_dot(const Options& options) const;
    int perform_describe(const Options& options) const;
    int perform_hosts(const Options& options) const;
};

}  // namespace lightnet
