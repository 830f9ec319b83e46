#include "tools/cli/request_of.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/allowance.hpp"
#include "core/network/graph/check_hosts.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "tools/cli/keys_of_run.hpp"
#include "tools/cli/overrides.hpp"

namespace lightnet {
namespace {

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

// The first entry for places of this process; null: there is none.
const HostEntry* first_here(const Hosts& hosts) {
    const auto found =
        std::find_if(hosts.hosts.begin(), hosts.hosts.end(), [](const HostEntry& entry) { return entry.is_here(); });
    return found == hosts.hosts.end() ? nullptr : &*found;
}

// What the hosts file says of this process is said there alone.
void check_threads(const RunningOptions& running, const Hosts& hosts) {
    if (const auto* here = first_here(hosts); here && running.threads)
        throw UserError(here->where, "place 'here': this file says which places this process has, and so --threads " +
                                         std::to_string(*running.threads) + " can't; leave it out, or write places = " +
                                         std::to_string(*running.threads) + " here");
}

// Who takes part: other hosts, or this process alone.
bool has_other_hosts(const RunningOptions& running, const Hosts& hosts) {
    const bool only_here = !hosts.hosts.empty() && std::all_of(hosts.hosts.begin(), hosts.hosts.end(),
                                                               [](const HostEntry& entry) { return entry.is_here(); });
    return (!running.hosts.empty() && !only_here) || !running.listen.empty() || running.local_workers;
}

// Places of this process: as many as its entries of the hosts file have, or as the command line says.
std::uint32_t own_places(const RunningOptions& running, const RunRequest& request, const Registry& registry) {
    if (!first_here(request.hosts)) return running.threads.value_or(request.mode == Mode::network ? 0 : usable_cores());
    return places_of_host(plan(request.graph, registry, request.hosts, {{"", 1}}), "");
}

}  // namespace

RunRequest request_of(const RunningOptions& running, const Launcher& launcher, Loaded loaded) {
    const auto& registry = launcher.registry;
    if (running.progress != ProgressMode::none) warn(loaded.warnings, launcher.err);
    auto keys = run_keys(running, loaded.hosts);
    check_threads(running, loaded.hosts);
    RunRequest request;
    static_cast<RunSettings&>(request) = running;
    request.scene = scene_file(loaded.graph, registry);
    request.output = output_file(loaded.graph, registry, running.picture);
    request.graph = std::move(loaded.graph);
    request.hosts = std::move(loaded.hosts);
    request.laid_out = std::move(loaded.laid_out);
    request.keys = std::move(keys);
    request.tuning.trace = !running.trace.empty();
    request.local_workers = running.local_workers.value_or(0);
    request.slurm = {running.slurm.value_or(0), running.partition, words_of(running.slurm_arguments)};
    request.ssh = {words_of(running.ssh_command), running.ssh_daemon};
    if (running.wait) request.wait = *(request.busy_wait = std::chrono::seconds(*running.wait));
    const auto shards = shards_of(request.graph, registry, request.hosts);
    request.graph = sharded(std::move(request.graph), shards);
    if (has_other_hosts(running, request.hosts)) request.mode = Mode::network;
    request.threads = own_places(running, request, registry);
    if (request.mode != Mode::network && (request.threads > 1 || first_here(request.hosts)))
        request.mode = Mode::threads;
    return request;
}

}  // namespace lightnet
