// The scheduler: all decisions of one asker, on who answers what and what to do when answers stay away.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/run/schedule/schedule_state.hpp"

namespace lightnet {

/// How often those who ask look whether replicas work at what they have.
inline constexpr double seconds_between_pulses = 0.25;

/// A pure state machine: it is told what happens and when, and says what is to be done. It has no clock, socket, thread
/// or random number, so the same events always give the same actions. Every decision takes O(log replicas).
///
/// Work is a bundle of questions, some tiles, or some shards of preparing: all three follow these rules. It is handed
/// out in copies: one, as a rule. A second copy goes to another replica, if that is idle, when the first is overdue
/// (its place may hang, or the network has lost it: Rescue), or when work runs out (speculative execution:
/// TailDoubling). Neither happens between replicas within the asker's process, where nothing is lost. The first answer
/// counts. Work that fails at one host is asked of another, once. Copies on a host that dies make their work suspect:
/// it is asked again alone, with nothing else on its host, and set aside after its third death alone, see Suspects.
/// With affinity, a region of scene or picture has a home, by consistent hashing, see HashRing. A replica is a place,
/// or a host with several, which work at the same time.
class Scheduler : public ScheduleTerms {
public:
    explicit Scheduler(const Rules& rules) : state_(std::make_unique<ScheduleState>(rules)) {}

    /// Appends to `actions`. Only a Tick sends.
    void on(const Event& event, Time now, std::vector<Action>& actions);

    /// Could more work be sent at once?
    bool has_room() const { return backlog().queues.first.empty() && order().first_open(); }
    /// Is anything waiting to be sent, or again?
    bool has_waiting() const;
    /// Something was refused, and is to be tried again soon.
    bool refused() const { return !state_->refused.empty(); }
    /// When a Tick is due though nothing else happens. TournamentTree::none: never.
    Time next_tick() const;
    /// Are as many replicas idle as have something to do? The reserve counts as idle.
    bool half_idle() const;
    /// Questions that are not answered: under way, not sent yet, and those of others that wait at the replicas.
    std::size_t questions_ahead() const;
    /// Is a copy of this work under way there?
    bool is_at(WorkId work, Replica replica) const;

    /// Replicas that may be asked, and what each is worth.
    const ReplicaBook& replicas() const { return state_->book; }
    const ReplicaOrder& order() const { return state_->order; }
    /// Work that is wanted and not done, and what of it is under way.
    const Backlog& backlog() const { return state_->backlog; }
    const InFlight& in_flight() const { return state_->in_flight; }
    const Counts& counts() const { return state_->counts; }

private:
    std::unique_ptr<ScheduleState> state_;
};

}  // namespace lightnet
