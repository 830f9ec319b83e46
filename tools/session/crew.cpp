#include "tools/session/crew.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "core/base/allowance.hpp"
#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "core/base/ip_address.hpp"
#include "core/base/suggestion.hpp"
#include "core/base/this_machine.hpp"
#include "core/network/graph/check_hosts.hpp"
#include "transport/launcher/lines_ahead.hpp"
#include "transport/zmq/zmq_hosts.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;

constexpr auto host_patience = 5s;     // for hosts that do not answer when the run begins
constexpr auto known_missing = 200ms;  // where some were not there at the end of the run before, either

// lightnetd stands beside the launcher.
std::string daemon_program() {
    return std::filesystem::read_symlink("/proc/self/exe").replace_filename("lightnetd").string();
}

// What others dial: a port on all addresses is known to them by the name of this machine.
std::string seen_from_elsewhere(const std::string& endpoint) {
    const auto parts = tcp_endpoint(endpoint);
    const auto number = parts ? ip_address(parts->host) : std::nullopt;
    return number && number->is_unspecified() ? TcpEndpoint{machine_name(), parts->port}.text() : endpoint;
}

// Where hosts come from stays as it is; of the run before nothing does.
Cluster::Options with_hosts_of(Cluster::Options before, Cluster::Options next) {
    next.endpoints = std::move(before.endpoints);
    next.listen = std::move(before.listen);
    next.key = std::move(before.key);
    next.host_keys = std::move(before.host_keys);
    next.join_keys = std::move(before.join_keys);
    next.pass = std::move(before.pass);
    next.expected = std::move(before.expected);
    next.threads = before.threads;
    next.transport = std::move(before.transport);
    return next;
}

}  // namespace

Crew::Crew(const RunRequest& request, Cluster::Options cluster, std::function<double()> done)
    : request_(&request), say_(cluster.say), done_(std::move(done)) {
    for (const auto& host : request.hosts.hosts) {
        if (host.is_here()) continue;
        const bool joins = !address_of(host.endpoint);
        if (joins && request.listen.empty())
            throw UserError(host.where, "place " + in_quotes(host.endpoint) +
                                            ": it joins by itself, which takes --listen tcp://HOST:PORT" +
                                            did_you_mean(host.endpoint, {std::string(own_process)}));
        (joins ? cluster.expected : cluster.endpoints).push_back(host.endpoint);
    }
    cluster.key = request.keys.own;
    cluster.host_keys = request.keys.hosts;
    cluster.join_keys = request.keys.join;
    for (const auto& host : request.keys.ssh) cluster.expected.push_back(host.name);
    if (request.local_workers) start_local_workers(cluster);
    cluster.listen = request.listen;
    cluster.pass = request.pass;
    cluster.threads = request.threads;
    if (request.shown) cluster.transport = lines_ahead(zmq_hosts());
    options_ = std::move(cluster);
    speak_for_run();
    cluster_ = std::make_unique<Cluster>(options_);
    if (!request.listen.empty()) say_("hosts may join at " + seen_from_elsewhere(cluster_->join_endpoint()));
    if (request.slurm.daemons) start_slurm();
    if (!request.keys.ssh.empty()) start_ssh();
}

void Crew::start_local_workers(Cluster::Options& cluster) {
    const auto cores = std::max(1u, usable_cores() / request_->local_workers);
    const auto places = request_->local_places ? request_->local_places : cores;
    const LocalWorkers::Keys keys{.launcher = request_->keys.own.open};
    auto cache = request_->tuning.cache == "none" ? "" : request_->tuning.cache;
    if (cache.empty()) cache = cache_or_spare(spare_cache_, "local workers keep", say_);
    local_.emplace(daemon_program(), request_->local_workers, places, keys, request_->troubles, std::move(cache));
    for (const auto& endpoint : local_->endpoints()) {
        cluster.endpoints.push_back(endpoint);
        cluster.host_keys[endpoint] = keys.workers.open;
    }
    if (const auto missing = local_->missing())
        say_(std::to_string(missing) + " of " + std::to_string(request_->local_workers) +
             " local workers did not start; the run goes on without");
}

void Crew::start_slurm() {
    SlurmWorkers::Request array{daemon_program(),
                                seen_from_elsewhere(cluster_->join_endpoint()),
                                request_->slurm.daemons,
                                request_->slurm.partition,
                                request_->slurm.arguments,
                                {},
                                request_->pass.empty() ? "" : std::filesystem::absolute(request_->pass).string()};
    if (const auto& key = request_->keys.slurm) {
        slurm_key_.emplace("slurm-" + key->open.fingerprint() + ".key", *key);
        array.keys = {slurm_key_->path(), request_->keys.own.open};
    }
    slurm_.emplace(array);
    say_("Slurm has taken job " + slurm_->job() + " of " + std::to_string(request_->slurm.daemons) + " daemons");
}

void Crew::start_ssh() {
    const auto endpoint = cluster_->join_endpoint();
    const auto daemon = request_->ssh.daemon.empty() ? daemon_program() : request_->ssh.daemon;
    ssh_.emplace(SshWorkers::Request{request_->keys.ssh, request_->ssh.command, daemon, seen_from_elsewhere(endpoint),
                                     seen_from_elsewhere(endpoint) != endpoint, request_->keys.own.open});
}

// Who has joined dials the same port again.
void Crew::begin_anew(std::uint64_t run, const std::set<std::string>& liars, std::shared_ptr<const Network> network) {
    options_.run = run;
    options_.liars = liars;
    options_.network = std::move(network);
    connect();
}

void Crew::connect() {
    if (!options_.listen.empty()) options_.listen = cluster_->join_endpoint();
    cluster_.reset();
    cluster_ = std::make_unique<Cluster>(options_);
}

// Hosts may still be heard when a run is over, and nobody of it is there any more to be told.
void Crew::speak_for_run() {
    say_ = std::move(options_.say);
    warn_ = options_.warn ? std::move(options_.warn) : say_;
    options_.say = [this](const std::string& text) {
        if (!ends_) say_(text);
    };
    options_.warn = [this](const std::string& text) {
        if (!ends_) warn_(text);
    };
}

void Crew::end_soon() {
    cluster_->finish(0ms);
    ends_ = true;
}

void Crew::begin_next(const RunRequest& request, Cluster::Options cluster, std::function<double()> done) {
    constexpr auto until_ended = 300ms;  // who has not by then says that it is busy
    if (ends_) cluster_->finish(until_ended);
    ends_ = false;
    some_missing_ = !cluster_->missing().empty();
    request_ = &request;
    done_ = std::move(done);
    options_ = with_hosts_of(std::move(options_), std::move(cluster));
    speak_for_run();
    connect();
}

void Crew::gather(const std::atomic<bool>& cancelled, std::optional<std::chrono::milliseconds> most) {
    HostPatience patience;
    patience.absent = patience.nobody = host_patience;
    if (some_missing_) patience.absent = known_missing;
    if (!request_->listen.empty()) patience.nobody = std::max<std::chrono::milliseconds>(request_->wait, host_patience);
    patience.busy = request_->busy_wait;
    patience.most = most;
    cluster_->gather(patience, cancelled, [this] { look_after(); });
}

std::vector<std::string> Crew::missing() const {
    std::vector<std::string> hosts;
    for (const auto& [name, why] : cluster_->missing()) {
        std::string nodes;
        for (const auto& entry : request_->hosts.hosts)
            if (entry.host() == name)
                for (const auto& [node, count] : entry.replicas) nodes += (nodes.empty() ? "" : ", ") + node;
        hosts.push_back(name + ": " + why + "; it was to hold " + (nodes.empty() ? "the whole network" : nodes));
    }
    return hosts;
}

void Crew::look_after() {
    const auto now = std::chrono::steady_clock::now();
    const auto of_use = [this](const std::string& host) { return cluster_->ready(host); };
    if (local_)
        local_->look_after(now,
                           {[this](const std::string& endpoint) { cluster_->lost(endpoint); }, of_use, say_, done_});
    if (ssh_) ssh_->look_after(now, {of_use, say_});
}

}  // namespace lightnet
