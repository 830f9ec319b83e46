// Speculative execution: at the end of a phase, what comes last is done twice.
#pragma once

#include "core/run/schedule/schedule_state.hpp"

namespace lightnet {

/// A view of a scheduler's state.
class TailDoubling {
public:
    using Time = ScheduleIds::Time;
    using Replica = ScheduleIds::Replica;

    explicit TailDoubling(ScheduleState& state) : state_(state) {}

    /// Idle replicas do once more what will otherwise come last, when work runs out.
    void double_tail(Time now);
    /// When there may be something to double though nothing else happens. TournamentTree::none: never.
    Time next_tick() const;

private:
    bool is_tail() const;
    bool may_be_afforded(std::size_t questions, double saves) const;
    double saved_by(Replica idle, const InFlight::Copy& copy, Time now) const;
    const InFlight::Copy* worth_doubling(Replica idle, Time now) const;
    template <class IsMeant>
    const InFlight::Copy* find(Replica replica, Replica idle, const IsMeant& is_meant) const;

    ScheduleState& state_;
};

}  // namespace lightnet
