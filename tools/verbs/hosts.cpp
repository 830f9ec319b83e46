// lightnet hosts: tells the state of daemons.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <ostream>

#include "core/base/build_info.hpp"
#include "tools/cli/asked_hosts.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/hosts/host_json.hpp"
#include "tools/hosts/host_table.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct HostsOptions {
    AskedHostsOptions asked;
    bool json = false;
};

void describe_hosts(CLI::App& app, HostsOptions& options) {
    app.add_option("WHOM", options.asked.whom, "hosts files, endpoints of daemons, or that of a launcher (--listen)")
        ->required();
    add_asking_keys(app, options.asked);
    app.add_flag("--json", options.json, "as JSON, for programs");
    add_examples(app, {"lightnet hosts tcp://127.0.0.1:7777"});
}

void complain(const Launcher& launcher, std::ptrdiff_t count, std::size_t all, const char* about) {
    launcher.err << "lightnet: " << count << " of " << all << (count == 1 ? " is " : " are ") << about << '\n';
}

int print_hosts(const HostsOptions& options, const Launcher& launcher) {
    const auto asked = asked_hosts(options.asked);
    const auto answers = ask_state(asked.called, std::chrono::seconds(2));
    launcher.out << (options.json ? host_json(answers, asked.joining, build_id()) : host_table(answers));
    for (const auto& host : answers)
        if (!host.advice.empty())
            launcher.err << "lightnet: " << host.asked << " " << host.state << ": " << host.advice << '\n';
    for (const auto& name : asked.joining)
        launcher.err << "lightnet: '" << name << "' joins by itself: ask its launcher (the endpoint behind --listen)\n";
    const auto absent = std::count_if(answers.begin(), answers.end(), [](const auto& host) { return !is_there(host); });
    const auto others = std::count_if(answers.begin(), answers.end(),
                                      [](const auto& host) { return is_other_build(host, build_id()); });
    if (absent) complain(launcher, absent, answers.size(), "not there");
    if (others) complain(launcher, others, answers.size(), "of another build, and would be refused");
    const bool all_unknown =
        std::all_of(answers.begin(), answers.end(), [](const auto& host) { return is_there(host) || host.unknown; });
    if (absent && all_unknown) return exit_code::unknown_key;
    return absent ? exit_code::no_worker : others ? exit_code::other_build : exit_code::done;
}

}  // namespace

Verb hosts_verb() {
    return verb<HostsOptions>("hosts", "show the state and load of daemons, and their machines", describe_hosts,
                              print_hosts);
}

}  // namespace lightnet
