// All that takes part in a run beside the launcher's own thread, wherever it comes from.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/request/run_request.hpp"
#include "tools/support/spare_cache.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/start/local_workers.hpp"
#include "transport/start/slurm_workers.hpp"
#include "transport/start/ssh_workers.hpp"

namespace lightnet {

/// Hosts that are called, local workers, daemons of Slurm and of ssh, and places of this process, in any mix. One
/// thread's.
class Crew {
public:
    /// `cluster` is what does not depend on where hosts come from. Starts what is to be started.
    /// `done`: the share of the picture that is there, for local workers that are to be lost in mid-run.
    Crew(const RunRequest& request, Cluster::Options cluster, std::function<double()> done);
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    Cluster& cluster() { return *cluster_; }
    /// All hosts but `liars` take part in another run, `run`, with `network` for places of this process; the one so far
    /// is over. gather() waits for them.
    void begin_anew(std::uint64_t run, const std::set<std::string>& liars, std::shared_ptr<const Network> network);
    /// All hosts take part in the next run, of another request for the same hosts: `cluster` and `done` are as for the
    /// first. The one so far is over. gather() waits for them.
    void begin_next(const RunRequest& request, Cluster::Options cluster, std::function<double()> done);
    /// The run so far is told to end; whoever begins the next waits until it has.
    void end_soon();
    /// Waits for those that are to be there from the beginning; no longer than `most`.
    void gather(const std::atomic<bool>& cancelled, std::optional<std::chrono::milliseconds> most);
    /// Hosts that the user named and that take no part: why, and what others have to do for them.
    std::vector<std::string> missing() const;
    /// To be called several times a second: starts local workers, and those of ssh, anew.
    void look_after();

private:
    void start_local_workers(Cluster::Options& cluster);
    void start_slurm();
    void start_ssh();
    void connect();
    void speak_for_run();

    const RunRequest* request_;
    bool some_missing_ = false;                           // hosts, when the last run was over: they may join in mid-run
    bool ends_ = false;                                   // see end_soon()
    std::function<void(const std::string&)> say_, warn_;  // of the run; nobody listens when it is over
    std::function<double()> done_;
    std::optional<SpareCache> spare_cache_;  // outlives the workers
    std::optional<LocalWorkers> local_;
    Cluster::Options options_;
    std::unique_ptr<Cluster> cluster_;
    std::optional<SecretFile> slurm_key_;  // outlives the job
    std::optional<SlurmWorkers> slurm_;
    std::optional<SshWorkers> ssh_;
};

}  // namespace lightnet
