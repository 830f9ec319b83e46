// lightnet hosts: tells the state of daemons.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <ostream>

#include "tools/asked_hosts.hpp"
#include "tools/command_line.hpp"
#include "tools/exit_code.hpp"
#include "tools/host_table.hpp"
#include "tools/launcher.hpp"

namespace lightnet {
namespace {

void describe_hosts(CLI::App& app, AskedHostsOptions& options) {
    app.add_option("WHOM", options.whom, "hosts files, endpoints of daemons, or that of a launcher (--listen)")
        ->required();
    add_asking_keys(app, options);
    add_examples(app, {"lightnet hosts tcp://127.0.0.1:7777"});
}

int print_hosts(const AskedHostsOptions& options, const Launcher& launcher) {
    const auto asked = asked_hosts(options);
    const auto answers = ask_state(asked.called, std::chrono::seconds(2));
    launcher.out << host_table(answers);
    for (const auto& name : asked.joining)
        launcher.err << "lightnet: '" << name << "' joins by itself: ask its launcher (the endpoint behind --listen)\n";
    const auto absent = std::count_if(answers.begin(), answers.end(), [](const auto& host) { return !is_there(host); });
    if (absent == 0) return exit_code::done;
    launcher.err << "lightnet: " << absent << " of " << answers.size() << (absent == 1 ? " is" : " are")
                 << " not there\n";
    return exit_code::no_worker;
}

}  // namespace

Verb hosts_verb() {
    return verb<AskedHostsOptions>("hosts", "show the state and load of daemons, and their machines", describe_hosts,
                                   print_hosts);
}

}  // namespace lightnet
