#include "tools/run_request.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/network/graph/check_hosts.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/layout.hpp"
#include "core/run/prepare/load_scene.hpp"
#include "tools/overrides.hpp"
#include "transport/wire/loopback.hpp"

namespace lightnet {
namespace {

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

// Packets are for everybody to read who is in between.
void check_reach(const RunningOptions& running, const Hosts& hosts) {
    std::vector<Problem> problems;
    for (const auto& host : hosts.hosts)
        if (!running.insecure && address_of(host.endpoint) && !stays_on_this_machine(host.endpoint))
            problems.push_back({host.where, beyond_this_machine("'" + host.endpoint + "'")});
    if (!problems.empty()) throw UserError(std::move(problems));
}

}  // namespace

RunRequest request_of(const RunningOptions& running, const Launcher& launcher, Loaded loaded) {
    const auto& registry = launcher.registry;
    if (running.progress != ProgressMode::none) warn(loaded.warnings, launcher.err);
    check_reach(running, loaded.hosts);
    RunRequest request;
    request.scene = scene_file(loaded.graph, registry);
    request.output = output_file(loaded.graph, registry, running.picture);
    request.graph = std::move(loaded.graph);
    request.hosts = std::move(loaded.hosts);
    request.seed = running.seed;
    request.preview = running.preview;
    request.progress = running.progress;
    request.listen = running.listen;
    request.pass = running.pass;
    request.tuning = running.tuning;
    request.local_workers = running.local_workers.value_or(0);
    request.slurm = {running.slurm.value_or(0), running.partition, words_of(running.slurm_arguments)};
    request.wait = std::chrono::seconds(running.wait);
    request.resume = running.resume;
    request.forget = running.forget;
    const bool network = !running.hosts.empty() || !running.listen.empty() || running.local_workers;
    request.threads = running.threads.value_or(network ? 0 : std::max(1u, std::thread::hardware_concurrency()));
    request.mode = network ? Mode::network : request.threads > 1 ? Mode::threads : Mode::serial;
    if (request.mode == Mode::network) {
        const auto shards = shards_of(request.graph, registry, request.hosts);
        request.graph = sharded(std::move(request.graph), shards);
    }
    return request;
}

}  // namespace lightnet
