#include "tools/cli/keys_of_run.hpp"

#include <algorithm>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "core/network/graph/check_hosts.hpp"
#include "tools/cli/options.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/wire/loopback.hpp"

namespace lightnet {
namespace {

void check_key(const HostEntry& host, bool insecure, std::vector<Problem>& problems) {
    const bool called = address_of(host.endpoint).has_value();
    if (host.key.empty() && called && !insecure && !stays_on_this_machine(host.endpoint))
        problems.push_back(
            {host.where, beyond_this_machine(in_quotes(host.endpoint),
                                             "say key = \"…\" here (lightnetd --print-key shows it there)")});
    if (host.key.empty()) return;
    if (host.is_here())
        problems.push_back({host.where, "place 'here': this process needs no key"});
    else if (const auto mistake = mistake_in_key(host.key); !mistake.empty())
        problems.push_back({host.where, "place " + in_quotes(host.endpoint) + ": " + mistake});
}

// Those that join are let in by it.
void take_keys(const Hosts& hosts, AllowList& joining, RunKeys& keys) {
    for (const auto& host : hosts.hosts) {
        const auto key = PublicKey::from(host.key);
        if (!key) continue;
        if (address_of(host.endpoint))
            keys.hosts.emplace(host.endpoint, *key);
        else
            joining.add(*key, host.endpoint);
    }
}

bool is_there(const std::string& file) {
    try {
        return key_is_there(file.empty() ? usual_key_file() : file);
    } catch (const Error&) {  // no home folder
        return false;
    }
}

// A file that the user named.
template <class Load>
auto as_users_mistake(Load load) {
    try {
        return load();
    } catch (const UserError&) {
        throw;
    } catch (const Error& error) {
        throw UserError(SourceLine{}, error.what());
    }
}

// "anna@onyx1" is called onyx1 in the run; a second one there, onyx1-2.
std::string name_for(const std::string& address, const std::vector<SshWorkers::Host>& others) {
    const auto machine = address.substr(address.find('@') + 1);
    auto name = machine;
    const auto is_taken = [&](const SshWorkers::Host& other) { return other.name == name; };
    for (int number = 2; std::any_of(others.begin(), others.end(), is_taken); ++number)
        name = machine + "-" + std::to_string(number);
    return name;
}

}  // namespace

KeyPair own_key(const std::string& file) {
    return as_users_mistake([&] { return load_key(file.empty() ? usual_key_file() : file); });
}

RunKeys run_keys(const RunningOptions& running, const Hosts& hosts) {
    std::vector<Problem> problems;
    for (const auto& host : hosts.hosts) check_key(host, running.insecure, problems);
    if (!problems.empty()) throw UserError(std::move(problems));
    RunKeys keys;
    AllowList joining;
    take_keys(hosts, joining, keys);
    if (running.slurm && !running.insecure) {
        keep_secrets_out_of_dumps();
        keys.slurm = KeyPair::random();
        joining.add(keys.slurm->open, "slurm-*");
    }
    for (const auto& address : running.ssh) {
        keys.ssh.push_back({address, name_for(address, keys.ssh), KeyPair::random()});
        joining.add(keys.ssh.back().key.open, keys.ssh.back().name);
    }
    const bool joined_by_key = !running.listen.empty() && (!running.allow.empty() || !joining.empty());
    if (joined_by_key) keys.join = JoinKeys{{}, joining};
    if (joined_by_key && !running.allow.empty())
        keys.join->file = as_users_mistake([&] { return AllowFile(running.allow); });
    // Whom others have on their lists is this user; a run whose hosts are started by it needs nobody else's trust.
    const bool known_to_others = !running.key.empty() || !keys.hosts.empty() || !running.allow.empty();
    if (known_to_others || (joined_by_key && is_there(running.key))) keys.own = own_key(running.key);
    return keys;
}

}  // namespace lightnet
