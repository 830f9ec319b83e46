// The rescue of work whose answers stay away: overdue work, failures, suspects.
#pragma once

#include <optional>

#include "core/run/schedule/schedule_state.hpp"

namespace lightnet {

/// A view of a scheduler's state.
class Rescue {
public:
    using Time = ScheduleIds::Time;
    using Replica = ScheduleIds::Replica;
    using Host = ScheduleIds::Host;
    using Item = Backlog::Item;

    explicit Rescue(ScheduleState& state) : state_(state) {}

    /// Overdue copies give their credit back.
    void write_off_overdue(Time now);
    /// Overdue work is asked again of who is idle.
    void ask_idle(Time now);
    /// It has failed once more.
    void fail(Item& item);
    /// Work that some hosts may not answer is asked of others.
    void retry(Time now);
    /// Suspects are tried alone.
    void test_suspects(Time now);

private:
    bool put_off(Replica replica, Time now);
    std::optional<Replica> idle_for(const Item& item);
    bool can_be_retried(const Item& item) const;
    void give_up(ScheduleIds::WorkId work);
    std::optional<Replica> best_allowed(const Item& item) const;
    Item* first_suspect();
    bool is_busy(Host host) const;
    void put_in_quarantine(Host host);
    void release_hosts();

    ScheduleState& state_;
};

}  // namespace lightnet
