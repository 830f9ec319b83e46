// lightnet describe: tells what kinds of nodes there are.
#include <CLI/CLI.hpp>

#include <ostream>
#include <string>
#include <vector>

#include "core/network/graph/check_params.hpp"
#include "core/network/graph/describe.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/schema_text.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct DescribeOptions {
    std::string kind;  // "": all
    bool json = false, meta = false, luacheck = false;
};

void describe_describe(CLI::App& app, DescribeOptions& options) {
    app.add_option("KIND", options.kind, "the kind to show");
    auto* const json = app.add_flag("--json", options.json, "for programs: types, units, defaults, ranges");
    auto* const meta = app.add_flag("--meta", options.meta, "for editors: definitions for the Lua language server");
    meta->excludes(json);
    app.add_flag("--luacheck", options.luacheck, "for luacheck: a .luacheckrc that knows all names")
        ->excludes(json)
        ->excludes(meta);
    add_examples(app, {"lightnet describe PhotonMap", "lightnet describe --json", "lightnet describe --meta"});
}

// In the form that was asked for; "": for people.
std::string written_for_programs(const DescribeOptions& options, const std::vector<Kind>& kinds) {
    return options.json       ? schema_json(kinds)
           : options.meta     ? lua_definitions(kinds)
           : options.luacheck ? luacheck_settings(kinds)
                              : "";
}

int describe_kinds(const DescribeOptions& options, const Launcher& launcher) {
    const auto& registry = launcher.registry;
    if (options.kind.empty()) {
        const auto written = written_for_programs(options, registry.kinds());
        launcher.out << (written.empty() ? describe(registry) : written);
        return exit_code::done;
    }
    if (const Kind* kind = registry.find(options.kind)) {
        const auto written = written_for_programs(options, {*kind});
        launcher.out << (written.empty() ? describe(*kind) : written);
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
