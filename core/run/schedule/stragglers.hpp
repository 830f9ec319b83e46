// Late copies of work: overdue ones, and those that keep the end of a phase waiting.
#pragma once

#include "core/run/schedule/schedule_ids.hpp"
#include "core/run/schedule/tournament_tree.hpp"

namespace lightnet {

/// Keeps, for each replica, when its copies are due, and knows the first and the last of all at once. It serves
/// speculative execution (the backup tasks of MapReduce, Dean & Ghemawat 2004): what comes last is done once more by
/// replicas that are idle.
class Stragglers {
public:
    using Time = ScheduleIds::Time;
    using Replica = ScheduleIds::Replica;

    /// Of one replica's copies. TournamentTree::none, and -TournamentTree::none for the last: it has no such copy.
    struct Due {
        Time overdue = TournamentTree::none;  // when the first of them is
        Time late = TournamentTree::none;     // when the first that may be done once more is late
        Time last = -TournamentTree::none;    // when the last of those is expected
    };
    void set(Replica replica, const Due& due) {
        overdue_.set(replica, due.overdue);
        late_.set(replica, due.late);
        last_.set(replica, -due.last);
    }

    /// When a copy is overdue; TournamentTree::none: never.
    Time next_overdue() const { return overdue_.least(); }
    Replica overdue_at() const { return static_cast<Replica>(overdue_.first()); }

    /// When a copy that may be done once more is late; TournamentTree::none: never.
    Time late() const { return late_.least(); }
    Replica late_at() const { return static_cast<Replica>(late_.first()); }
    /// When the last that may be done once more is expected; -TournamentTree::none: there is none.
    Time last() const { return -last_.least(); }
    Replica last_at() const { return static_cast<Replica>(last_.first()); }

private:
    TournamentTree overdue_, late_;
    TournamentTree last_;  // backwards
};

}  // namespace lightnet
