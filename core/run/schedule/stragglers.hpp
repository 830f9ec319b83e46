// Which copies of work are late: overdue ones, and those that keep the end of a phase waiting.
#pragma once

#include "core/run/schedule/lowest.hpp"
#include "core/run/schedule/schedule_ids.hpp"

namespace lightnet {

/// Keeps, for each replica, when its copies are due, and knows the first and the last of all at once. It serves
/// speculative execution (the backup tasks of MapReduce, Dean & Ghemawat 2004): what comes last is done once more by
/// replicas that are idle.
class Stragglers {
public:
    using Time = ScheduleIds::Time;
    using Replica = ScheduleIds::Replica;

    /// Of one replica's copies. Lowest::none, and -Lowest::none for the last: it has no such copy.
    struct Due {
        Time overdue = Lowest::none;  // when the first of them is
        Time first = Lowest::none;    // when the first that may be done once more is expected
        Time last = -Lowest::none;    // and when the last
    };
    void set(Replica replica, const Due& due) {
        overdue_.set(replica, due.overdue);
        first_.set(replica, due.first);
        last_.set(replica, -due.last);
    }

    /// When a copy is overdue; Lowest::none: never.
    Time next_overdue() const { return overdue_.least(); }
    Replica overdue_at() const { return static_cast<Replica>(overdue_.first()); }

    /// Is there a copy that may be done once more?
    bool any() const { return first_.any(); }
    Time first() const { return first_.least(); }
    Replica first_at() const { return static_cast<Replica>(first_.first()); }
    Time last() const { return -last_.least(); }
    Replica last_at() const { return static_cast<Replica>(last_.first()); }

private:
    Lowest overdue_, first_;
    Lowest last_;  // backwards
};

}  // namespace lightnet
