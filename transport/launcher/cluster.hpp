// The hosts of a run, as the launcher sees them.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/network/graph/plan.hpp"
#include "core/run/assembly/activity.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/message/carrier.hpp"
#include "core/run/message/figures.hpp"
#include "transport/keys/allow_list.hpp"
#include "transport/launcher/host_patience.hpp"
#include "transport/wire/machine.hpp"

namespace lightnet {

class HostTransport;

/// One host of a run, for display.
struct HostState {
    std::string name;    // as in plans
    std::string state;   // "ready", "does not answer", …
    bool there = false;  // it takes part, or did until it was told to stop
    std::uint32_t places = 0;
    std::uint64_t progress = 0;  // bundles and tiles answered, as of its last heartbeat
    Machine machine;
    HostFigures figures{};          // see Cluster::watch()
    std::uint64_t peak_memory = 0;  // of its process, in this run; bytes
};

/// Brings hosts into the run, keeps their leases, and carries the master's asks to them, and those that hosts can't
/// send to each other. Hosts are called, or dial in, or are places of this process. A host that is lost, stops or comes
/// late changes what is proposed: the new plan comes out of receive(), and goes to hosts when it is adopted. Used by
/// one thread, which must look in (receive() or wait()) several times a second, as it also sends the heartbeats.
class Cluster final : public Carrier {
public:
    struct Options {
        std::uint64_t run = 0;
        std::string who;                             // runs it, for those who have to wait
        std::vector<std::string> endpoints;          // of hosts to call
        std::string listen;                          // where hosts may join; empty: nowhere
        std::optional<KeyPair> key;                  // ours; to be had where hosts have one
        std::map<std::string, PublicKey> host_keys;  // of those to call that have one, by endpoint
        std::optional<JoinKeys> join_keys;  // of those that may join; none: they show by the pass that they belong here
        std::chrono::milliseconds line_life = usual_line_life;  // of one with keys
        std::string pass;                        // file with what they must know; empty: Pass::usual_file()
        std::vector<std::string> expected;       // names of hosts that are to join before the work begins
        std::set<std::string> liars;             // names of hosts that take no part, as they have answered falsely
        std::uint32_t threads = 0;               // places of this process, called "" in plans
        std::shared_ptr<const Network> network;  // for them
        Job job;
        std::map<std::string, Bytes> files;                       // the scene's, by path
        std::function<Plan(const std::vector<HostOffer>&)> plan;  // for the hosts that are there
        std::function<bool()> moved = [] {
            return false;
        };  // does `plan` give another now, though nobody came or went?
        std::function<void(const std::string&)> say = [](const std::string&) {};
        std::function<void(const std::string&)> warn{};  // of what a user should look at; empty: as `say`
        std::shared_ptr<HostTransport> transport{};      // to hosts; null: by ZeroMQ
    };
    explicit Cluster(Options options);
    /// What `call()` is told of whoever it calls.
    using HostKey = std::optional<PublicKey>;
    ~Cluster() override;

    /// Returns when every host is ready, refused, or has been absent or slow for too long; at least one must be ready
    /// by then, and others may still join later. Says from time to time what it waits for. Calls `look_around` several
    /// times a second. Throws NoWorker when none is ready by then, Error when the job can't be served.
    void gather(
        HostPatience patience, const std::atomic<bool>& cancelled, const std::function<void()>& look_around = [] {});
    /// What is proposed now.
    const Plan& plan() const;
    /// Calls another host.
    void call(const std::string& endpoint, const HostKey& key = std::nullopt);
    /// A host whose process is known to have ended.
    void lost(const std::string& name);
    bool ready(const std::string& name) const;
    std::vector<HostState> hosts() const;
    /// From now on, hosts are asked, too, what their places are at: it then stands in hosts().
    void watch();
    /// A host finishes what it has and then leaves the run for good; its daemon stays for others. False: it does not,
    /// as it is unknown, can't, or would leave nobody who is ready.
    bool drain(const std::string& name);
    /// What nodes say that they do while they prepare, on whichever hosts.
    Doings doing() const;
    /// Somebody has answered falsely: two others say so of him, or one has said so and it is word against word (the
    /// host is ""). What he has told may be in all that has been computed since, so the run is to begin anew. None:
    /// nobody was found.
    const std::optional<Failure>& lie() const;
    /// Lines that took the place of others, which were old.
    std::uint64_t renewed_lines() const;
    /// Hosts that were named and take no part now → why.
    std::map<std::string, std::string> missing() const;
    /// Where hosts may join, with the port that the system chose.
    std::string join_endpoint() const;
    /// Ends the run on all hosts and returns what they counted, as far as they say so within `patience`.
    Counters finish(std::chrono::milliseconds patience = std::chrono::seconds(1));

    bool ask(const PlaceAt& to, Message& message) override;
    void reply(Message message) override;
    std::optional<Message> receive() override;
    void wait(std::chrono::nanoseconds most) override;
    bool take_out(const std::string& host, const std::string& why) override;
    bool expects_hosts() const override;
    void doubt(const Failure& lie) override;
    void forget(const PlaceAt&) override {}
    bool bring(const PlaceAt& to, const Hash& name, const Bytes& bytes) override;
    /// Every host asks by this plan from now on.
    void adopt(const Plan& plan) override;
    std::uint64_t pulse(const std::string& host) const override;
    const Counters& counters() const override;

private:
    struct Links;
    std::unique_ptr<Links> links_;
};

/// No host can be reached, or none is free in time (exit code 3).
class NoWorker : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};
/// No host can be reached, as we and they don't know each other by our keys (exit code 4).
class NobodyKnown final : public NoWorker {
public:
    using NoWorker::NoWorker;
};

}  // namespace lightnet
