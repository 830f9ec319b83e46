// The replicas of a scheduler: who is there, on which hosts, and whose regions are whose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "core/run/schedule/hash_ring.hpp"
#include "core/run/schedule/schedule_terms.hpp"

namespace lightnet {

/// Replicas that come, change and go. One thread's.
class ReplicaBook {
public:
    using Time = ScheduleIds::Time;
    using Replica = ScheduleIds::Replica;
    using Host = ScheduleIds::Host;
    using OnHosts = std::map<Host, std::set<Replica>>;

    struct State {
        bool present = false, draining = false, refused = false;
        bool silent = false;  // something is overdue, and no reply has come since it was sent
        bool reserve = false, within_process = false;
        Host host = 0;
        std::uint64_t name = 0, process = 0;
        Credit credit;
        std::uint32_t places = 1;
        std::size_t others = 0;  // questions that others have waiting there
        double patience = 0;
        Time last_reply = 0;
        Time last_sign = 0;  // of life

        void replied(Time now) { last_reply = last_sign = now, silent = false; }
    };

    /// `with_homes`: regions of scene or picture belong to replicas. What the asker keeps in reserve is nobody's home.
    explicit ReplicaBook(bool with_homes) : with_homes_(with_homes) {}

    State& operator[](Replica replica) { return states_.at(replica); }
    const State& operator[](Replica replica) const { return states_.at(replica); }
    /// Above all numbers of replicas.
    Replica end() const { return static_cast<Replica>(states_.size()); }

    /// `patience`: seconds without a sign of life that any work may take there.
    void join(const ScheduleTerms::Joined& event, double patience);
    void resize(const ScheduleTerms::Resized& event);
    void drain(const ScheduleTerms::Draining& event);
    /// Returns whether it was the last of its host.
    bool leave(Replica replica);

    /// Replicas that are present.
    const OnHosts& on_hosts() const { return hosts_; }
    std::size_t present() const { return present_; }
    /// Places behind them.
    std::size_t places() const { return places_; }
    /// Replicas that are not within the asker's process.
    std::size_t elsewhere() const { return elsewhere_; }
    /// The asker itself, where it may be asked.
    std::optional<Replica> reserve() const { return reserve_; }
    bool has_homes() const { return !homes_.empty(); }
    /// The replica to which a region belongs; only when there is one.
    Replica home(std::uint64_t region) const { return homes_.owner_of(region); }

private:
    void give_home(Replica replica);

    bool with_homes_;
    std::vector<State> states_;  // by number
    OnHosts hosts_;
    HashRing homes_;
    std::optional<Replica> reserve_;
    std::size_t present_ = 0, places_ = 0, elsewhere_ = 0;
};

}  // namespace lightnet
