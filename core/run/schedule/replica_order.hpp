// The order of replicas: what each is worth to an asker, and who comes first.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/run/schedule/in_flight.hpp"
#include "core/run/schedule/replica_book.hpp"
#include "core/run/schedule/service_times.hpp"
#include "core/run/schedule/suspects.hpp"
#include "core/run/schedule/tournament_tree.hpp"

namespace lightnet {

/// Keeps replicas in the order in which they would be done, by what is under way to them and how long they took so far.
/// Each change of a replica costs O(log replicas). One thread's.
class ReplicaOrder {
public:
    using Replica = ScheduleIds::Replica;

    /// What decides where a replica stands. Outlives it.
    struct Looks {
        const ReplicaBook& book;
        const InFlight& in_flight;
        const Suspects& suspects;
    };
    explicit ReplicaOrder(Looks at) : at_(at) {}

    /// Something of this replica has changed.
    void refresh(Replica replica);
    /// Work of so many questions was added. True: replicas are compared by another size from now on, and each is to be
    /// refreshed.
    bool note_size(std::size_t questions);

    const ServiceTimes& times() const { return times_; }
    ServiceTimes& times() { return times_; }
    /// When `replica` would have answered `questions` more, in seconds from now, as far as is known.
    double completion_time(Replica replica, std::size_t questions) const;
    /// When whoever would be asked next would have answered `questions` more, in seconds from now. None: nobody but the
    /// reserve may be asked now.
    std::optional<double> soonest(std::size_t questions) const;

    bool is_open(Replica replica) const;
    bool has_idle_place(Replica replica) const;
    /// The lower, the sooner it is asked.
    double key(Replica replica) const;
    /// Of those that take more work.
    std::optional<Replica> first_open() const;
    /// None of `holders`, unless nobody else is open. Only when somebody is.
    Replica first_open_but(std::span<const Replica> holders);
    /// Of those that have nothing to do; the reserve comes last.
    std::optional<Replica> first_idle() const;
    std::optional<Replica> first_idle_but(std::span<const Replica> holders);
    std::optional<Replica> first_idle_elsewhere() const;
    /// The one that would be done with usual work first, open or not; none: nothing is known.
    std::optional<Replica> quickest() const;
    /// Replicas that are open and have a place with nothing to do; the reserve does not count.
    std::size_t idle() const { return idle_count_; }

private:
    double ahead(Replica replica) const;

    Looks at_;
    ServiceTimes times_;
    // Who takes more work, and who of them is idle but for the reserve, by key(); those of known speed, open or not, by
    // completion of usual work.
    TournamentTree open_, idle_, all_;
    std::vector<bool> counted_idle_;
    std::size_t idle_count_ = 0;
    double mean_size_ = 0, usual_ = 0;  // questions of work lately; by how many replicas are compared
};

}  // namespace lightnet
