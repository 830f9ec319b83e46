// The in_flight of copies under way: where they are, and whose credit they take.
#pragma once

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/run/schedule/schedule_ids.hpp"

namespace lightnet {

/// Keeps the books of what was sent and not answered, by copy and by replica. A copy that is written off gives its
/// credit back, and is remembered: its answer would still be welcome.
class InFlight {
public:
    using Time = ScheduleIds::Time;
    using WorkId = ScheduleIds::WorkId;
    using CopyId = ScheduleIds::CopyId;
    using Replica = ScheduleIds::Replica;

    struct Copy {
        CopyId id = 0;
        WorkId work = 0;
        std::size_t questions = 0, bytes = 0;
        Time sent = 0, expected = 0;  // TournamentTree::none: nothing is known
        Time late = 0, overdue = 0;
        double patience = 0;  // seconds without a sign of life
    };
    /// Of one replica.
    struct Account {
        std::vector<Copy> copies;                            // that take credit
        std::vector<std::pair<CopyId, WorkId>> written_off;  // that take none any more
        std::size_t questions = 0, bytes = 0;                // of the copies
        std::size_t size() const { return copies.size() + written_off.size(); }
    };
    /// What a copy that comes back was.
    struct Closed {
        Replica replica;
        WorkId work;
        std::optional<Copy> copy;  // none: it was written off
    };

    const Account& of(Replica replica) const;
    /// Where a copy is that is not forgotten.
    std::optional<Replica> replica_of(CopyId copy) const;
    std::optional<WorkId> work_of(CopyId copy) const;
    std::size_t questions() const { return questions_; }
    std::size_t copies() const { return copies_; }

    /// A copy is sent; its `id` is given here.
    CopyId open(Replica replica, Copy copy);
    /// Changes when copies of a replica are expected: revise(copy).
    template <class Revise>
    void expect(Replica replica, const Revise& revise) {
        for (auto& copy : accounts_[replica].copies) revise(copy);
    }
    /// It comes back, or never will: it is forgotten. None: it was already.
    std::optional<Closed> close(CopyId copy);
    /// Of the copy that is overdue first; only where there is one.
    Copy write_off_first(Replica replica);
    /// Everything of a replica that is gone.
    Account close_all(Replica replica);

private:
    struct Entry {
        Replica replica;
        WorkId work;
        bool written_off = false;
    };
    Copy take(Replica replica, CopyId copy);

    std::unordered_map<CopyId, Entry> entries_;
    std::vector<Account> accounts_;  // by replica
    std::size_t questions_ = 0, copies_ = 0;
    CopyId next_ = 1;
};

}  // namespace lightnet
