// lightnet hosts: tells the state of daemons.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <ostream>
#include <string>
#include <vector>

#include "core/network/graph/check_hosts.hpp"
#include "lua/load_graph.hpp"
#include "tools/command_line.hpp"
#include "tools/exit_code.hpp"
#include "tools/host_table.hpp"
#include "tools/launcher.hpp"
#include "tools/run_keys.hpp"

namespace lightnet {
namespace {

struct HostsOptions {
    std::vector<std::string> whom;  // endpoints and hosts files
    std::string key;                // file with our own; "": the usual one
    std::string host_key;           // of the endpoints that stand on the command line
};

void describe_hosts(CLI::App& app, HostsOptions& options) {
    app.add_option("WHOM", options.whom, "hosts files, endpoints of daemons, or that of a launcher (--listen)")
        ->required();
    app.add_option("--key", options.key, "file with our secret key (default: ~/.config/lightnet/key)")
        ->type_name("FILE");
    app.add_option("--host-key", options.host_key, "public key of the daemons that are named by their endpoints")
        ->type_name("KEY")
        ->check([](const std::string& text) { return mistake_in_key(text); });
    add_examples(app, {"lightnet hosts tcp://127.0.0.1:7777"});
}

int print_hosts(const HostsOptions& options, const Launcher& launcher) {
    std::vector<AskedHost> asked;
    std::vector<std::string> joining;
    auto add = [&, own = std::optional<KeyPair>()](const std::string& endpoint, const std::string& key) mutable {
        const auto theirs = PublicKey::from(key);
        if (theirs && !own) own = own_key(options.key);
        asked.push_back({endpoint, theirs ? std::optional(LineKeys{*own, *theirs}) : std::nullopt});
    };
    for (const auto& one : options.whom) {
        if (address_of(one)) {
            add(one, options.host_key);
            continue;
        }
        for (const auto& host : load_hosts(one).hosts) {
            if (host.is_here()) continue;
            if (address_of(host.endpoint))
                add(host.endpoint, host.key);
            else
                joining.push_back(host.endpoint);
        }
    }
    const auto answers = ask_state(asked, std::chrono::seconds(2));
    launcher.out << host_table(answers);
    for (const auto& name : joining)
        launcher.err << "lightnet: '" << name << "' joins by itself: ask its launcher (the endpoint behind --listen)\n";
    const auto absent = std::count_if(answers.begin(), answers.end(), [](const auto& host) { return !is_there(host); });
    if (absent == 0) return exit_code::done;
    launcher.err << "lightnet: " << absent << " of " << answers.size() << (absent == 1 ? " is" : " are")
                 << " not there\n";
    return exit_code::no_worker;
}

}  // namespace

Verb hosts_verb() {
    return verb<HostsOptions>("hosts", "show the state and load of daemons, and their machines", describe_hosts,
                              print_hosts);
}

}  // namespace lightnet
