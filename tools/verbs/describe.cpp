// lightnet describe: tells what kinds of nodes there are.
#include <CLI/CLI.hpp>

#include <ostream>
#include <string>
#include <vector>

#include "core/network/graph/check_params.hpp"
#include "core/network/graph/describe.hpp"
#include "tools/command_line.hpp"
#include "tools/exit_code.hpp"
#include "tools/launcher.hpp"

namespace lightnet {
namespace {

struct DescribeOptions {
    std::string kind;  // "": all
};

void describe_describe(CLI::App& app, DescribeOptions& options) {
    app.add_option("KIND", options.kind, "the kind to show");
    add_examples(app, {"lightnet describe PhotonMap"});
}

int describe_kinds(const DescribeOptions& options, const Launcher& launcher) {
    const auto& registry = launcher.registry;
    if (options.kind.empty()) {
        launcher.out << describe(registry);
        return exit_code::done;
    }
    if (const Kind* kind = registry.find(options.kind)) {
        launcher.out << describe(*kind);
        return exit_code::done;
    }
    std::vector<std::string> known;
    for (const auto& kind : registry.kinds()) known.push_back(kind.name);
    launcher.err << "lightnet: there is no kind '" << options.kind << "'" << suggest(options.kind, known) << '\n';
    return exit_code::usage;
}

}  // namespace

Verb describe_verb() {
    return verb<DescribeOptions>("describe", "list the kinds of nodes, or show all about one", describe_describe,
                                 describe_kinds);
}

}  // namespace lightnet
