// The state of a scheduler, and what all its parts do with it.
#pragma once

#include <vector>

#include "core/run/schedule/backlog.hpp"
#include "core/run/schedule/in_flight.hpp"
#include "core/run/schedule/replica_book.hpp"
#include "core/run/schedule/replica_order.hpp"
#include "core/run/schedule/schedule_terms.hpp"
#include "core/run/schedule/stragglers.hpp"
#include "core/run/schedule/suspects.hpp"

namespace lightnet {

/// What is known of work, replicas and copies. Its functions keep these in step with each other.
struct ScheduleState {
    using Item = Backlog::Item;

    explicit ScheduleState(const ScheduleTerms::Rules& its_rules);
    ScheduleState(const ScheduleState&) = delete;
    ScheduleState& operator=(const ScheduleState&) = delete;

    /// Something of this replica, or of its copies, has changed.
    void refresh(ScheduleIds::Replica replica);
    /// Something of work that is under way there has changed.
    void refresh_due(ScheduleIds::Replica replica);
    void refresh_all();
    /// Gives the replica a copy of it.
    void send(Item& item, ScheduleIds::Replica replica, ScheduleIds::Time now);
    /// It waits to be sent again, in the queue where it belongs.
    void wait_again(Item& item);
    /// Likewise, if nobody is at it any more.
    void ask_again(Item& item);
    /// Forgets about work. What is still under way of it keeps its credit until it is answered or overdue.
    void finish(ScheduleIds::WorkId work);
    /// May an idle replica do once more what this copy is of?
    bool may_be_doubled(const InFlight::Copy& copy) const;
    /// Seconds after which what is expected to take so many is late.
    double late_after(double expected) const;

    ScheduleTerms::Rules rules;
    Backlog backlog;
    InFlight in_flight;
    Suspects suspects;
    ReplicaBook book;
    ReplicaOrder order;
    Stragglers stragglers;
    bool more_hosts = false;  // may still join
    std::vector<ScheduleIds::Replica> refused;
    ScheduleTerms::Counts counts;
    std::size_t questions_doubled = 0;
    std::vector<ScheduleTerms::Action>* actions = nullptr;  // where what is to be done is appended
};

}  // namespace lightnet
