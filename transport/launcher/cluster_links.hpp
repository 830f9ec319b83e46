// The parts of a cluster. For its .cpp files.
#pragma once

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/log_bounds.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/launcher/host_wait.hpp"
#include "transport/launcher/join_listener.hpp"
#include "transport/launcher/relays.hpp"
#include "transport/launcher/remote_host.hpp"
#include "transport/zmq/zmq_hosts.hpp"

namespace lightnet {

/// The links to all hosts, of which this process is the first if it has places; all of it belongs to the thread of the
/// cluster.
struct Cluster::Links {
    using Clock = std::chrono::steady_clock;
    using State = HostLink::State;
    static constexpr double strangers_per_minute = 20;  // that are told of

    Options options;
    RunOffer offer;
    std::shared_ptr<const SocketContext> context;  // null: its hosts come another way, and it has no places
    std::optional<JoinListener> joiners;           // hosts that dial in
    std::vector<std::unique_ptr<HostLink>> links;
    std::map<std::string, State> states;     // as last told
    std::map<std::string, unsigned> losses;  // of hosts that took part
    LogBounds strangers{strangers_per_minute};
    Plan plan;                            // proposed
    std::optional<WrittenPlan> in_force;  // that hosts are to go by
    std::deque<Message> arrived;
    AllowList members;                  // those with keys, by name
    std::set<std::string> unknown;      // said already
    std::set<std::string> turned_down;  // who wanted to join
    std::optional<Failure> lie;         // that was found first
    bool watched = false;
    Counters counters, ended;
    Relays relays{counters, relay_handlers()};
    ExpectedHosts expected;  // that are not ready yet

    explicit Links(Options given);

    HostLink* find(const std::string& name) const {
        for (auto& link : links)
            if (link->name() == name) return link.get();
        return nullptr;
    }
    void call(const std::string& endpoint, const HostKey& key);
    void add(const std::string& name, std::unique_ptr<HostConnection> connection, const HostKey& key);
    // Hosts may not know the names of others as we do.
    void tell_numbers();
    // Hosts are there, but they and we don't know each other's keys.
    bool all_unknown() const;

    // Offers of all hosts that are at least so far, in the order in which they were named.
    std::vector<HostOffer> offers(bool ready_only) const;

    // Hosts that leave hold no node any more, but are still there: their askers wait for what is under way.
    Plan plan_for(const std::vector<HostOffer>& there) const;
    std::uint32_t places_before(const HostLink& link) const { return places_of_host(plan, link.name()); }

    void look();

    // The last one stays, unless others are expected: its failures are the run's.
    bool take_out(const std::string& name, const std::string& why);
    bool others_are_ready(const std::string& name) const;

    // `accuser`: the host that says so; "": places of this process, or the launcher itself, which are believed.
    void doubt(Failure found, const std::string& accuser);

    // Until something can be read.
    void wait(std::chrono::nanoseconds most);
    void take_joiners(Clock::time_point now);
    Relays::Handlers relay_handlers();

    // Hosts that became ready or are no more, or nodes that move: a new plan is proposed, and a line said of hosts.
    void tell_changes();
    void tell_loss(const HostLink& link);
    // Of somebody who is not of the run, and may come as often as he likes.
    void say_of_stranger(const std::string& text);
    std::vector<HostState> hosts() const;
    std::string reasons() const;
    void say_what_is_missing(Clock::duration waited) const;

    // Somebody who is to be there from the beginning is not.
    bool absent() const;
    HostWait::Standing standing() const;
};

}  // namespace lightnet
