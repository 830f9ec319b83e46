#include "tools/cli/asked_hosts.hpp"

#include <CLI/CLI.hpp>
#include <optional>

#include "core/network/graph/check_hosts.hpp"
#include "lua/load_graph.hpp"
#include "tools/cli/keys_of_run.hpp"

namespace lightnet {

void add_asking_keys(CLI::App& app, AskedHostsOptions& options) {
    app.add_option("--key", options.key, "file with our secret key (default: ~/.config/lightnet/key)")
        ->type_name("FILE");
    app.add_option("--host-key", options.host_key, "public key of the daemons that are named by their endpoints")
        ->type_name("KEY")
        ->check([](const std::string& text) { return mistake_in_key(text); });
}

AskedHosts asked_hosts(const AskedHostsOptions& options) {
    AskedHosts found;
    std::optional<KeyPair> own;
    const auto call = [&](const std::string& endpoint, const std::string& key) {
        const auto theirs = PublicKey::from(key);
        if (theirs && !own) own = own_key(options.key);
        found.called.push_back({endpoint, theirs ? std::optional(LineKeys{*own, *theirs}) : std::nullopt});
    };
    for (const auto& one : options.whom) {
        if (address_of(one)) {
            call(one, options.host_key);
            continue;
        }
        for (const auto& host : load_hosts(one).hosts) {
            if (host.is_here()) continue;
            if (address_of(host.endpoint))
                call(host.endpoint, host.key);
            else
                found.joining.push_back(host.endpoint);
        }
    }
    return found;
}

}  // namespace lightnet
